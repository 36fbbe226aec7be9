#include "numerics/solver.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "textbook.hpp"

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using nsma::IpoptSolver;
using nsma::NloptMethod;
using nsma::solve_with_nlopt;
using nsma::SolverOptions;
using nsma::SolverOutcome;

const Vector3d start(0.48, 0.6, 0.64);  // on the sphere, away from every optimum

void expect_optimum(const textbook::Case& item, const SolverOutcome& outcome, double tolerance) {
    ASSERT_EQ(outcome.x.size(), 3) << item.name;
    EXPECT_LT(item.program.violation(outcome.x), tolerance) << item.name << ": " << outcome.status;
    EXPECT_NEAR(item.program.objective(outcome.x), item.value, tolerance) << item.name << ": " << outcome.status;
    // On a smooth optimum x is known to the root of what the objective is.
    EXPECT_LT((outcome.x - item.optimum).norm(), 20 * std::sqrt(tolerance)) << item.name;
    EXPECT_GT(outcome.iterations, 0);
    EXPECT_GE(outcome.seconds, 0.0);
}

TEST(IpoptSolver, FindsTextbookOptima) {
    IpoptSolver solver;
    for (const auto& item : textbook::all()) {
        const auto outcome = solver.solve(item.program, start);
        EXPECT_EQ(outcome.status, "Solve_Succeeded") << item.name;
        expect_optimum(item, outcome, 1e-7);  // asked for 1e-10, scaled; barrier terms remain
    }
}

TEST(NloptSolver, FindsTextbookOptima) {
    for (const auto& item : textbook::all()) {
        expect_optimum(item, solve_with_nlopt(NloptMethod::slsqp, item.program, start), 1e-7);
        // NLopt's L-BFGS gives up on this program and says so.
        if (item.name == "trust region") continue;
        // First order multiplier updates stop at about 1e-5.
        expect_optimum(item, solve_with_nlopt(NloptMethod::auglag_lbfgs, item.program, start), 1e-4);
    }
}

TEST(NloptSolver, CobylaReturnsAndIsNear) {
    const auto item = textbook::linear_on_cap();
    const auto outcome = solve_with_nlopt(NloptMethod::cobyla, item.program, start);
    EXPECT_LE(outcome.iterations, 10 * SolverOptions{}.max_iterations + 1);
    EXPECT_NEAR(item.program.objective(outcome.x), item.value, 1e-3);  // no derivatives
}

TEST(Solvers, AgreeOnAGridOfStarts) {
    IpoptSolver ipopt;
    for (const auto& item : textbook::all()) {
        for (int i = 0; i < 12; ++i) {
            const double angle = 0.3 + 2 * M_PI * i / 12;
            const double height = std::sin(1.7 * i);
            const Vector3d from(std::cos(angle) * std::cos(height), std::sin(angle) * std::cos(height),
                                std::sin(height));
            const auto a = ipopt.solve(item.program, from);
            const auto b = solve_with_nlopt(NloptMethod::slsqp, item.program, from);
            ASSERT_LT(item.program.violation(a.x), 1e-6) << item.name << " start " << i << " " << a.status;
            ASSERT_LT(item.program.violation(b.x), 1e-6) << item.name << " start " << i << " " << b.status;
            // Neither may be below the proven optimum by more than its violation explains.
            EXPECT_GT(item.program.objective(a.x), item.value - 1e-5);
            EXPECT_GT(item.program.objective(b.x), item.value - 1e-5);
            if (item.name == "trust region") continue;  // it has a second local optimum
            EXPECT_NEAR(item.program.objective(a.x), item.program.objective(b.x), 1e-6) << item.name << " start " << i;
        }
    }
}

TEST(Solvers, InfeasibleIsNeverAFeasiblePoint) {
    // Whatever the library says (SLSQP may claim success), the residual tells.
    const auto program = textbook::infeasible();
    EXPECT_EQ(IpoptSolver().solve(program, start).status, "Infeasible_Problem_Detected");
    EXPECT_GT(program.violation(IpoptSolver().solve(program, start).x), 1e-2);
    for (const auto method : {NloptMethod::slsqp, NloptMethod::auglag_lbfgs, NloptMethod::cobyla}) {
        EXPECT_GT(program.violation(solve_with_nlopt(method, program, start).x), 1e-2);
    }
}

TEST(Solvers, IterationLimit) {
    SolverOptions options;
    options.max_iterations = 1;
    const auto item = textbook::trust_region();
    const auto outcome = IpoptSolver(options).solve(item.program, start);
    EXPECT_EQ(outcome.status, "Maximum_Iterations_Exceeded");
    EXPECT_LE(outcome.iterations, 1);
    EXPECT_TRUE(outcome.x.allFinite());
    const auto other = solve_with_nlopt(NloptMethod::cobyla, item.program, start, options);
    EXPECT_EQ(other.status, "MAXEVAL_REACHED");
    EXPECT_LE(other.iterations, 10 + 1);
}

TEST(Solvers, TimeLimit) {
    SolverOptions options;
    options.time_limit = 1e-9;
    const auto item = textbook::trust_region();
    const auto outcome = IpoptSolver(options).solve(item.program, start);
    EXPECT_TRUE(outcome.status == "Time_Limit_Exceeded" || outcome.status == "Maximum_CpuTime_Exceeded")
        << outcome.status;
    const auto other = solve_with_nlopt(NloptMethod::slsqp, item.program, start, options);
    EXPECT_EQ(other.status, "MAXTIME_REACHED");
}

TEST(Solvers, TooFewDegreesOfFreedomIsAStatus) {
    // Three planes and the sphere: four equalities for three unknowns.
    auto program = textbook::unit_sphere({1, 0, 0});
    const Eigen::MatrixXd planes = Eigen::Matrix3d::Identity();
    program.equalities = planes.sparseView();
    program.equality_values = Vector3d(0, 0, 1);
    const auto outcome = IpoptSolver().solve(program, start);
    EXPECT_EQ(outcome.status, "Not_Enough_Degrees_Of_Freedom");
    EXPECT_FALSE(outcome.x.allFinite());  // the library gave no point: none is invented
    EXPECT_NO_THROW((void)solve_with_nlopt(NloptMethod::slsqp, program, start));
}

TEST(Solvers, RefuseBadStartsAndPrograms) {
    IpoptSolver ipopt;
    const auto program = textbook::trust_region().program;
    auto crossed = program;
    crossed.lower[1] = 1;
    crossed.upper[1] = 0.5;
    auto poisoned = program;
    poisoned.gradient[0] = std::numeric_limits<double>::quiet_NaN();
    const Vector3d nan(0, std::nan(""), 1);
    EXPECT_THROW((void)ipopt.solve(program, nan), std::invalid_argument);
    EXPECT_THROW((void)ipopt.solve(program, VectorXd::Zero(2)), std::invalid_argument);
    EXPECT_THROW((void)ipopt.solve(crossed, start), std::invalid_argument);
    EXPECT_THROW((void)ipopt.solve(poisoned, start), std::invalid_argument);
    for (const auto method : {NloptMethod::slsqp, NloptMethod::auglag_lbfgs, NloptMethod::cobyla}) {
        EXPECT_THROW((void)solve_with_nlopt(method, program, nan), std::invalid_argument);
        EXPECT_THROW((void)solve_with_nlopt(method, program, VectorXd::Zero(2)), std::invalid_argument);
        EXPECT_THROW((void)solve_with_nlopt(method, crossed, start), std::invalid_argument);
        EXPECT_THROW((void)solve_with_nlopt(method, poisoned, start), std::invalid_argument);
    }
}

TEST(Solvers, RefuseOptionsTheLibraryDoesNotTake) {
    SolverOptions options;
    options.tolerance = -1;
    EXPECT_THROW(IpoptSolver{options}, std::invalid_argument);
    options = {};
    options.max_iterations = -5;
    EXPECT_THROW(IpoptSolver{options}, std::invalid_argument);
}

TEST(IpoptSolver, RepeatsToTheBitOnOneObject) {
    IpoptSolver solver;
    std::vector<VectorXd> first;
    for (int round = 0; round < 3; ++round) {
        std::size_t i = 0;
        for (const auto& item : textbook::all()) {  // other programs in between
            const VectorXd x = solver.solve(item.program, start).x;
            if (round == 0) {
                first.push_back(x);
            } else {
                EXPECT_EQ(x, first[i]) << item.name;
            }
            ++i;
        }
    }
    EXPECT_EQ(IpoptSolver().solve(textbook::all()[0].program, start).x, first[0]);  // as on a new one
}

TEST(IpoptSolver, AFailureLeavesNothingBehind) {
    IpoptSolver solver;
    const auto item = textbook::trust_region();
    const VectorXd before = solver.solve(item.program, start).x;
    (void)solver.solve(textbook::infeasible(), start);
    EXPECT_EQ(solver.solve(item.program, start).x, before);
    IpoptSolver moved = std::move(solver);
    EXPECT_EQ(moved.solve(item.program, start).x, before);
}

TEST(IpoptSolver, IgnoresAnOptionFileInTheWorkingDirectory) {
    namespace fs = std::filesystem;
    const auto item = textbook::trust_region();
    const auto plain = IpoptSolver().solve(item.program, start);
    const fs::path before = fs::current_path();
    const fs::path folder = fs::temp_directory_path() / ("nsma-options-" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "ipopt.opt") << "max_iter 0\ntol 0.1\n";
    fs::current_path(folder);
    const auto here = IpoptSolver().solve(item.program, start);
    fs::current_path(before);
    fs::remove_all(folder);
    EXPECT_EQ(here.status, plain.status);
    EXPECT_EQ(here.iterations, plain.iterations);
    EXPECT_EQ(here.x, plain.x);
}

TEST(Solvers, BoundsHoldExactly) {
    // bound_relax_factor = 0: the default of Ipopt leaves 1e-8.
    const auto item = textbook::convex();
    EXPECT_LE(IpoptSolver().solve(item.program, start).x[0], 1.0);
    EXPECT_LE(solve_with_nlopt(NloptMethod::slsqp, item.program, start).x[0], 1.0);
}

TEST(Solvers, NameTheirVersions) {
    EXPECT_EQ(nsma::ipopt_version().substr(0, 2), "3.");
    EXPECT_EQ(nsma::nlopt_version().substr(0, 2), "2.");
}

}  // namespace
