// What the failure table says of the libraries themselves, run apart from the tests because it may
// hang or crash. solver_child CASE: exit code 0 when the case returned, and one line on stdout.
#include <cstdio>
#include <cstring>
#include <thread>
#include <vector>

#include <nlopt.hpp>

#include "../numerics/textbook.hpp"
#include "numerics/solver.hpp"
#include "nsma/search/orbit_solver.hpp"

namespace {

double sum(unsigned n, const double* x, double* gradient, void*) {
    double value = 0;
    for (unsigned i = 0; i < n; ++i) {
        value += x[i];
        if (gradient != nullptr) gradient[i] = 1;
    }
    return value;
}

double sphere(unsigned n, const double* x, double* gradient, void*) {
    double value = -1;
    for (unsigned i = 0; i < n; ++i) {
        value += x[i] * x[i];
        if (gradient != nullptr) gradient[i] = 2 * x[i];
    }
    return value;
}

/// Row 7: COBYLA on a sphere without xtol.
void raw_cobyla() {
    nlopt::opt optimiser(nlopt::LN_COBYLA, 3);
    optimiser.set_min_objective(sum, nullptr);
    optimiser.add_equality_constraint(sphere, nullptr, 1e-10);
    optimiser.set_maxeval(1000);
    optimiser.set_maxtime(0.1);
    std::vector<double> x{0.48, 0.6, 0.64};
    double value = 0;
    optimiser.optimize(x, value);
}

/// Row 8: AUGLAG without a local optimiser.
void raw_auglag() {
    nlopt::opt optimiser(nlopt::AUGLAG, 3);
    optimiser.set_min_objective(sum, nullptr);
    optimiser.add_equality_constraint(sphere, nullptr, 1e-10);
    optimiser.set_maxeval(1000);
    std::vector<double> x{0.48, 0.6, 0.64};
    double value = 0;
    optimiser.optimize(x, value);
}

/// Row 12: our own adapter, against its documentation, from four threads.
void threads() {
    std::vector<std::thread> all;
    for (int t = 0; t < 4; ++t) {
        all.emplace_back([] {
            for (int round = 0; round < 20; ++round) {
                nsma::IpoptSolver solver;
                for (const auto& item : textbook::all()) {
                    (void)solver.solve(item.program, textbook::Vector3d(0.48, 0.6, 0.64));
                }
            }
        });
    }
    for (auto& thread : all) thread.join();
}

/// One of our methods, on a program it cannot finish in the time it gets.
void ours(nsma::NloptMethod method) {
    nsma::SolverOptions options;
    options.time_limit = 0.05;
    options.tolerance = 1e-16;
    options.max_iterations = 100'000'000;
    constexpr int n = 60;
    nsma::Program program;
    program.lower = Eigen::VectorXd::Constant(n, -1);
    program.upper = Eigen::VectorXd::Constant(n, 1);
    program.gradient = Eigen::VectorXd::LinSpaced(n, -1, 2);
    const Eigen::MatrixXd hessian = Eigen::VectorXd::LinSpaced(n, -3, 5).asDiagonal();
    program.hessian = hessian.sparseView();
    program.equalities.resize(0, n);
    program.inequalities.resize(0, n);
    program.sphere_variables = n;
    const Eigen::VectorXd start = Eigen::VectorXd::Ones(n).normalized();
    const auto outcome = nsma::solve_with_nlopt(method, program, start, options);
    std::printf("%s %.3f\n", outcome.status.c_str(), outcome.seconds);
}

}  // namespace

int main(int count, char** words) {
    const char* name = count == 2 ? words[1] : "";
    const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
    try {
        if (is("raw-cobyla"))
            raw_cobyla();
        else if (is("raw-auglag"))
            raw_auglag();
        else if (is("threads"))
            threads();
        else if (is("cobyla"))
            ours(nsma::NloptMethod::cobyla);
        else if (is("auglag"))
            ours(nsma::NloptMethod::auglag_lbfgs);
        else if (is("slsqp"))
            ours(nsma::NloptMethod::slsqp);
        else
            return 2;
    } catch (const std::exception& error) {
        std::printf("%s\n", error.what());
        return 1;
    }
    return 0;
}
