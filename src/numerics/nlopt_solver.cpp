#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>

#include <nlopt.hpp>

#include "solver.hpp"

#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

using Point = Eigen::Map<const Eigen::VectorXd>;

// What the C callbacks share: the program, and the first thing that went wrong in one of them.
struct Call {
    const Program& program;
    nlopt::opt& optimiser;
    std::chrono::steady_clock::time_point deadline;
    std::exception_ptr failure = nullptr;
    int evaluations = 0;
    bool late = false;

    // Runs the inside of a callback, through which no exception may pass; false where there was one.
    // The library looks at its own clock between iterations of its choice, and a local optimiser
    // inside AUGLAG at none: every callback looks too, and the next check of the library ends it.
    template <typename Evaluate>
    bool guard(const Evaluate& evaluate) {
        late = late || std::chrono::steady_clock::now() >= deadline;
        if (late || stop_requested()) optimiser.force_stop();
        try {
            evaluate();
            return true;
        } catch (...) {
            if (!failure) failure = std::current_exception();
            optimiser.force_stop();
            return false;
        }
    }
};

void expect_finite(double value, const std::string& what) {
    if (!std::isfinite(value)) throw std::domain_error("non-finite value of " + what);
}

void expect_finite(const double* values, unsigned count, const char* what) {
    for (unsigned i = 0; i < count; ++i) expect_finite(values[i], what + std::to_string(i));
}

double objective(unsigned n, const double* x, double* gradient, void* data) {
    auto& call = *static_cast<Call*>(data);
    ++call.evaluations;
    double value = 0;
    const bool good = call.guard([&] {
        const Point point(x, n);
        if (gradient != nullptr) {
            Eigen::Map<Eigen::VectorXd>(gradient, n) = call.program.hessian * point + call.program.gradient;
        }
        value = call.program.objective(point);
        expect_finite(value, "the objective");
    });
    return good ? value : std::numeric_limits<double>::max();
}

void write_rows(const SparseRows& rows, const Eigen::VectorXd& values, const Point& point, double* result,
                double* gradient) {
    const auto n = point.size();
    for (Eigen::Index i = 0; i < rows.outerSize(); ++i) {
        double sum = -values[i];
        if (gradient != nullptr) std::fill(gradient + i * n, gradient + (i + 1) * n, 0.0);
        for (SparseRows::InnerIterator entry(rows, i); entry; ++entry) {
            sum += entry.value() * point[entry.col()];
            if (gradient != nullptr) gradient[i * n + entry.col()] = entry.value();
        }
        result[i] = sum;
    }
}

void inequalities(unsigned count, double* result, unsigned n, const double* x, double* gradient, void* data) {
    auto& call = *static_cast<Call*>(data);
    const bool good = call.guard([&] {
        write_rows(call.program.inequalities, call.program.inequality_values, Point(x, n), result, gradient);
        expect_finite(result, count, "inequality ");
    });
    if (!good) std::fill(result, result + count, 0.0);
}

void equalities(unsigned count, double* result, unsigned n, const double* x, double* gradient, void* data) {
    auto& call = *static_cast<Call*>(data);
    const bool good = call.guard([&] {
        const Point point(x, n);
        const auto& program = call.program;
        write_rows(program.equalities, program.equality_values, point, result, gradient);
        if (program.sphere_variables > 0) {
            result[count - 1] = point.head(program.sphere_variables).squaredNorm() - 1.0;
            if (gradient != nullptr) {
                Eigen::Map<Eigen::VectorXd> row(gradient + std::size_t{count - 1} * n, n);
                row.setZero();
                row.head(program.sphere_variables) = 2.0 * point.head(program.sphere_variables);
            }
        }
        expect_finite(result, count, "equality ");
    });
    if (!good) std::fill(result, result + count, 0.0);
}

nlopt::algorithm algorithm(NloptMethod method) {
    switch (method) {
        case NloptMethod::slsqp: return nlopt::LD_SLSQP;
        case NloptMethod::auglag_lbfgs:
        case NloptMethod::auglag_slsqp: return nlopt::AUGLAG;
        case NloptMethod::cobyla: return nlopt::LN_COBYLA;
        case NloptMethod::isres: return nlopt::GN_ISRES;
    }
    throw std::invalid_argument("method: expected a method of NLopt");
}

const char* result_name(nlopt::result result) {
    switch (result) {
        case nlopt::SUCCESS: return "SUCCESS";
        case nlopt::STOPVAL_REACHED: return "STOPVAL_REACHED";
        case nlopt::FTOL_REACHED: return "FTOL_REACHED";
        case nlopt::XTOL_REACHED: return "XTOL_REACHED";
        case nlopt::MAXEVAL_REACHED: return "MAXEVAL_REACHED";
        case nlopt::MAXTIME_REACHED: return "MAXTIME_REACHED";
        default: return "FAILURE";
    }
}

void set_tolerances(nlopt::opt& optimiser, const SolverOptions& options) {
    optimiser.set_xtol_rel(options.tolerance);  // COBYLA without it never returns
    optimiser.set_ftol_rel(options.tolerance * 1e-2);
    optimiser.set_maxeval(10 * options.max_iterations);
}

// Hands the program to NLopt, which refuses more equalities than unknowns here already.
void pose(NloptMethod method, Call& call, const SolverOptions& options) {
    const Program& program = call.program;
    nlopt::opt& optimiser = call.optimiser;
    std::vector<double> lower(program.lower.begin(), program.lower.end());
    std::vector<double> upper(program.upper.begin(), program.upper.end());
    if (method == NloptMethod::isres && program.sphere_variables > 0) {
        // On the unit sphere no unknown exceeds one; the peak force does not either.
        for (auto& bound : lower) bound = std::max(bound, -1.0);
        for (auto& bound : upper) bound = std::min(bound, 1.0);
        nlopt::srand(1);  // the same answer in every run
    }
    optimiser.set_lower_bounds(lower);
    optimiser.set_upper_bounds(upper);
    optimiser.set_min_objective(objective, &call);
    const auto tolerances = [&](Eigen::Index rows) {
        return std::vector<double>(static_cast<std::size_t>(rows), options.tolerance);
    };
    if (const auto rows = program.inequalities.rows(); rows > 0)
        optimiser.add_inequality_mconstraint(inequalities, &call, tolerances(rows));
    if (const auto rows = program.equalities.rows() + (program.sphere_variables > 0 ? 1 : 0); rows > 0)
        optimiser.add_equality_mconstraint(equalities, &call, tolerances(rows));
    set_tolerances(optimiser, options);
    optimiser.set_maxtime(options.time_limit);
    if (method == NloptMethod::auglag_lbfgs || method == NloptMethod::auglag_slsqp) {
        // AUGLAG without a local optimiser crashes.
        const bool lbfgs = method == NloptMethod::auglag_lbfgs;
        nlopt::opt local(lbfgs ? nlopt::LD_LBFGS : nlopt::LD_SLSQP, optimiser.get_dimension());
        set_tolerances(local, options);
        optimiser.set_local_optimizer(local);
    }
}

// The library's own word for how it ended; x becomes its last point.
std::string optimise(NloptMethod method, Call& call, const SolverOptions& options, std::vector<double>& x) {
    std::string status;
    try {
        pose(method, call, options);
        double value = 0;
        status = result_name(call.optimiser.optimize(x, value));
    } catch (const nlopt::roundoff_limited&) {
        status = "ROUNDOFF_LIMITED";
    } catch (const nlopt::forced_stop&) {
        status = "FORCED_STOP";
    } catch (const std::invalid_argument&) {
        status = "INVALID_ARGS";
    } catch (const std::runtime_error&) {
        status = "FAILURE";
    }
    try {
        if (call.failure) std::rethrow_exception(call.failure);
    } catch (const std::domain_error& error) {
        status = error.what();  // a numerical outcome; anything else goes on up
    }
    return call.late ? "MAXTIME_REACHED" : status;
}

}  // namespace

SolverOutcome solve_with_nlopt(NloptMethod method, const Program& program, const Eigen::VectorXd& start,
                               const SolverOptions& options) {
    validate(program, start);
    // At zero COBYLA never returns, and calls nothing that could stop it.
    if (!(options.tolerance > 0)) {
        throw std::invalid_argument("tolerance: expected > 0, got " + std::to_string(options.tolerance));
    }
    if (!(options.time_limit > 0)) {
        throw std::invalid_argument("time_limit: expected > 0 s, got " + std::to_string(options.time_limit));
    }
    const auto begin = std::chrono::steady_clock::now();
    // Longer than a year is no limit, and would not fit the clock.
    const std::chrono::duration<double> limit(std::min(options.time_limit, 3e7));
    nlopt::opt optimiser(algorithm(method), static_cast<unsigned>(program.variables()));
    Call call{program, optimiser, begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit)};
    // Rounding may leave a start outside its bounds by one unit, which NLopt refuses.
    const Eigen::VectorXd inside = start.cwiseMax(program.lower).cwiseMin(program.upper);
    std::vector<double> x(inside.begin(), inside.end());
    SolverOutcome outcome;
    outcome.status = optimise(method, call, options, x);
    stop_point();
    outcome.x = Point(x.data(), program.variables());
    outcome.iterations = call.evaluations;
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
}

std::string nlopt_version() {
    int major = 0;
    int minor = 0;
    int bugfix = 0;
    nlopt::version(major, minor, bugfix);
    return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(bugfix);
}

}  // namespace nsma
