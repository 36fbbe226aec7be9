#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>

#include <nlopt.hpp>

#include "solver.hpp"

namespace nsma {
namespace {

using Point = Eigen::Map<const Eigen::VectorXd>;

// What the C callbacks share: the program, and the first thing that went wrong in one of them.
struct Call {
    const Program& program;
    nlopt::opt* optimiser = nullptr;
    std::chrono::steady_clock::time_point deadline;
    std::exception_ptr failure;
    int evaluations = 0;
    bool late = false;

    void fail(std::exception_ptr error) {
        if (!failure) failure = std::move(error);
        optimiser->force_stop();
    }
    // The library looks at its own clock between iterations of its choice, and a local optimiser
    // inside AUGLAG at none: every callback looks too, and the next check of the library ends it.
    void look_at_the_clock() {
        if (std::chrono::steady_clock::now() < deadline) return;
        late = true;
        optimiser->force_stop();
    }
    void expect_finite(double value, const std::string& what) {
        if (std::isfinite(value)) return;
        throw std::domain_error("non-finite value of " + what);
    }
};

double objective(unsigned n, const double* x, double* gradient, void* data) {
    auto& call = *static_cast<Call*>(data);
    ++call.evaluations;
    call.look_at_the_clock();
    try {
        const Point point(x, n);
        if (gradient != nullptr) {
            Eigen::Map<Eigen::VectorXd>(gradient, n) = call.program.hessian * point + call.program.gradient;
        }
        const double value = call.program.objective(point);
        call.expect_finite(value, "the objective");
        return value;
    } catch (...) {
        call.fail(std::current_exception());
        return std::numeric_limits<double>::max();
    }
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
    call.look_at_the_clock();
    try {
        write_rows(call.program.inequalities, call.program.inequality_values, Point(x, n), result, gradient);
        for (unsigned i = 0; i < count; ++i) {
            call.expect_finite(result[i], "inequality " + std::to_string(i));
        }
    } catch (...) {
        call.fail(std::current_exception());
        std::fill(result, result + count, 0.0);
    }
}

void equalities(unsigned count, double* result, unsigned n, const double* x, double* gradient, void* data) {
    auto& call = *static_cast<Call*>(data);
    call.look_at_the_clock();
    try {
        const Point point(x, n);
        const auto& program = call.program;
        write_rows(program.equalities, program.equality_values, point, result, gradient);
        if (program.sphere_variables > 0) {
            result[count - 1] = point.head(program.sphere_variables).squaredNorm() - 1.0;
            if (gradient != nullptr) {
                Eigen::Map<Eigen::VectorXd> row(gradient + (count - 1) * n, n);
                row.setZero();
                row.head(program.sphere_variables) = 2.0 * point.head(program.sphere_variables);
            }
        }
        for (unsigned i = 0; i < count; ++i) {
            call.expect_finite(result[i], "equality " + std::to_string(i));
        }
    } catch (...) {
        call.fail(std::current_exception());
        std::fill(result, result + count, 0.0);
    }
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

}  // namespace

SolverOutcome solve_with_nlopt(NloptMethod method, const Program& program, const Eigen::VectorXd& start,
                               const SolverOptions& options) {
    validate(program);
    if (start.size() != program.variables() || !start.allFinite()) {
        throw std::invalid_argument("start: expected " + std::to_string(program.variables()) + " finite values, got " +
                                    std::to_string(start.size()));
    }
    const auto n = static_cast<unsigned>(program.variables());
    // At zero COBYLA never returns, and calls nothing that could stop it.
    if (!(options.tolerance > 0)) {
        throw std::invalid_argument("tolerance: expected > 0, got " + std::to_string(options.tolerance));
    }
    if (!(options.time_limit > 0)) {
        throw std::invalid_argument("time_limit: expected > 0 s, got " + std::to_string(options.time_limit));
    }
    const auto begin = std::chrono::steady_clock::now();
    nlopt::opt optimiser(algorithm(method), n);
    // Longer than a year is no limit, and would not fit the clock.
    const std::chrono::duration<double> limit(std::min(options.time_limit, 3e7));
    Call call{program, &optimiser, begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit),
              nullptr, 0,          false};

    const auto set_up = [&] {
        std::vector<double> lower(program.lower.data(), program.lower.data() + n);
        std::vector<double> upper(program.upper.data(), program.upper.data() + n);
        if (method == NloptMethod::isres && program.sphere_variables > 0) {
            // On the unit sphere no unknown exceeds one; the peak force does not either.
            for (auto& bound : lower) bound = std::max(bound, -1.0);
            for (auto& bound : upper) bound = std::min(bound, 1.0);
            nlopt::srand(1);  // the same answer in every run
        }
        optimiser.set_lower_bounds(lower);
        optimiser.set_upper_bounds(upper);
        optimiser.set_min_objective(objective, &call);
        if (program.inequalities.rows() > 0) {
            const std::vector<double> tolerance(static_cast<std::size_t>(program.inequalities.rows()),
                                                options.tolerance);
            optimiser.add_inequality_mconstraint(inequalities, &call, tolerance);
        }
        const auto equality_count =
            static_cast<std::size_t>(program.equalities.rows()) + (program.sphere_variables > 0 ? 1U : 0U);
        if (equality_count > 0) {
            optimiser.add_equality_mconstraint(equalities, &call,
                                               std::vector<double>(equality_count, options.tolerance));
        }
        optimiser.set_xtol_rel(options.tolerance);  // COBYLA without it never returns
        optimiser.set_ftol_rel(options.tolerance * 1e-2);
        optimiser.set_maxeval(10 * options.max_iterations);
        optimiser.set_maxtime(options.time_limit);
        if (method == NloptMethod::auglag_lbfgs || method == NloptMethod::auglag_slsqp) {
            const bool lbfgs = method == NloptMethod::auglag_lbfgs;
            nlopt::opt local(lbfgs ? nlopt::LD_LBFGS : nlopt::LD_SLSQP, n);  // AUGLAG without a local optimiser crashes
            local.set_xtol_rel(options.tolerance);
            local.set_ftol_rel(options.tolerance * 1e-2);
            local.set_maxeval(10 * options.max_iterations);
            optimiser.set_local_optimizer(local);
        }
    };

    SolverOutcome outcome;
    std::vector<double> x(start.data(), start.data() + n);
    // Rounding may leave a start outside its bounds by one unit, which NLopt refuses.
    for (unsigned j = 0; j < n; ++j) x[j] = std::clamp(x[j], program.lower[j], program.upper[j]);
    try {
        set_up();  // NLopt refuses more equalities than unknowns here already
        double value = 0;
        outcome.status = result_name(optimiser.optimize(x, value));
    } catch (const nlopt::roundoff_limited&) {
        outcome.status = "ROUNDOFF_LIMITED";
    } catch (const nlopt::forced_stop&) {
        outcome.status = "FORCED_STOP";
    } catch (const std::invalid_argument&) {
        outcome.status = "INVALID_ARGS";
    } catch (const std::bad_alloc&) {
        outcome.status = "OUT_OF_MEMORY";
    } catch (const std::runtime_error&) {
        outcome.status = "FAILURE";
    }
    if (call.failure) {
        try {
            std::rethrow_exception(call.failure);
        } catch (const std::domain_error& error) {
            outcome.status = error.what();  // a numerical outcome; anything else goes on up
        }
    }
    if (call.late) outcome.status = "MAXTIME_REACHED";
    outcome.x = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
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
