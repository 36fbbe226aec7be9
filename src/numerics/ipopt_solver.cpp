#include <chrono>
#include <exception>
#include <limits>
#include <stdexcept>

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <coin/IpTNLP.hpp>

#include "solver.hpp"

#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr double infinite = 2e19;  // at or beyond it Ipopt sees no bound

const char* status_name(Ipopt::ApplicationReturnStatus status) {
    switch (status) {
        case Ipopt::Solve_Succeeded: return "Solve_Succeeded";
        case Ipopt::Solved_To_Acceptable_Level: return "Solved_To_Acceptable_Level";
        case Ipopt::Infeasible_Problem_Detected: return "Infeasible_Problem_Detected";
        case Ipopt::Search_Direction_Becomes_Too_Small: return "Search_Direction_Becomes_Too_Small";
        case Ipopt::Diverging_Iterates: return "Diverging_Iterates";
        case Ipopt::User_Requested_Stop: return "User_Requested_Stop";
        case Ipopt::Feasible_Point_Found: return "Feasible_Point_Found";
        case Ipopt::Maximum_Iterations_Exceeded: return "Maximum_Iterations_Exceeded";
        case Ipopt::Restoration_Failed: return "Restoration_Failed";
        case Ipopt::Error_In_Step_Computation: return "Error_In_Step_Computation";
        case Ipopt::Maximum_CpuTime_Exceeded: return "Maximum_CpuTime_Exceeded";
        case Ipopt::Not_Enough_Degrees_Of_Freedom: return "Not_Enough_Degrees_Of_Freedom";
        case Ipopt::Invalid_Problem_Definition: return "Invalid_Problem_Definition";
        case Ipopt::Invalid_Option: return "Invalid_Option";
        case Ipopt::Invalid_Number_Detected: return "Invalid_Number_Detected";
        case Ipopt::Unrecoverable_Exception: return "Unrecoverable_Exception";
        case Ipopt::NonIpopt_Exception_Thrown: return "NonIpopt_Exception_Thrown";
        case Ipopt::Insufficient_Memory: return "Insufficient_Memory";
        default: return "Internal_Error";
    }
}

// The program in Ipopt's terms: constraints in the order equalities, inequalities, sphere.
class Adapter final : public Ipopt::TNLP {
public:
    Adapter(const Program& program, const Eigen::VectorXd& start, double deadline)
        : program_(program),
          start_(start),
          deadline_(deadline),
          x_(Eigen::VectorXd::Constant(start.size(), std::numeric_limits<double>::quiet_NaN())),
          lower_triangle_(program.hessian.triangularView<Eigen::Lower>()) {
        // The sphere adds to the diagonal, so its entries must exist.
        for (Index j = 0; j < program.sphere_variables; ++j) lower_triangle_.coeffRef(j, j) += 0.0;
        lower_triangle_.makeCompressed();
    }
    Adapter(Program&&, const Eigen::VectorXd&, double) = delete;

    [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
    [[nodiscard]] int iterations() const { return iterations_; }
    [[nodiscard]] bool timed_out() const { return timed_out_; }

    bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
        n = static_cast<Index>(program_.variables());
        m = static_cast<Index>(program_.equalities.rows() + program_.inequalities.rows()) +
            (program_.sphere_variables > 0 ? 1 : 0);
        jacobian = static_cast<Index>(program_.equalities.nonZeros() + program_.inequalities.nonZeros()) +
                   program_.sphere_variables;
        hessian = static_cast<Index>(lower_triangle_.nonZeros());
        style = C_STYLE;
        return true;
    }

    bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* row_lower,
                         Number* row_upper) override {
        for (Index j = 0; j < n; ++j) {
            lower[j] = std::max(program_.lower[j], -infinite);
            upper[j] = std::min(program_.upper[j], infinite);
        }
        const auto equalities = static_cast<Index>(program_.equalities.rows());
        for (Index i = 0; i < equalities; ++i) {
            row_lower[i] = row_upper[i] = program_.equality_values[i];
        }
        for (Index i = 0; i < static_cast<Index>(program_.inequalities.rows()); ++i) {
            row_lower[equalities + i] = -infinite;
            row_upper[equalities + i] = program_.inequality_values[i];
        }
        if (program_.sphere_variables > 0) row_lower[m - 1] = row_upper[m - 1] = 1.0;
        return true;
    }

    bool get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number*, Number*, Index, bool init_lambda,
                            Number*) override {
        if (!init_x || init_z || init_lambda) return false;
        Eigen::Map<Eigen::VectorXd>(x, n) = start_;
        return true;
    }

    bool eval_f(Index n, const Number* x, bool, Number& value) override {
        value = program_.objective(Eigen::Map<const Eigen::VectorXd>(x, n));
        return true;
    }

    bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
        Eigen::Map<Eigen::VectorXd>(gradient, n) =
            program_.hessian * Eigen::Map<const Eigen::VectorXd>(x, n) + program_.gradient;
        return true;
    }

    bool eval_g(Index n, const Number* x, bool, Index m, Number* values) override {
        const Eigen::Map<const Eigen::VectorXd> point(x, n);
        Eigen::Map<Eigen::VectorXd> result(values, m);
        result.head(program_.equalities.rows()) = program_.equalities * point;
        result.segment(program_.equalities.rows(), program_.inequalities.rows()) = program_.inequalities * point;
        if (program_.sphere_variables > 0) {
            result[m - 1] = point.head(program_.sphere_variables).squaredNorm();
        }
        return true;
    }

    bool eval_jac_g(Index, const Number* x, bool, Index m, Index, Index* rows, Index* columns,
                    Number* values) override {
        Index k = 0;
        const auto write = [&](const SparseRows& matrix, Index offset) {
            for (Eigen::Index i = 0; i < matrix.outerSize(); ++i) {
                for (SparseRows::InnerIterator entry(matrix, i); entry; ++entry, ++k) {
                    if (values != nullptr) {
                        values[k] = entry.value();
                    } else {
                        rows[k] = offset + static_cast<Index>(i);
                        columns[k] = static_cast<Index>(entry.col());
                    }
                }
            }
        };
        write(program_.equalities, 0);
        write(program_.inequalities, static_cast<Index>(program_.equalities.rows()));
        for (Index j = 0; j < program_.sphere_variables; ++j, ++k) {
            if (values != nullptr) {
                values[k] = 2.0 * x[j];
            } else {
                rows[k] = m - 1;
                columns[k] = j;
            }
        }
        return true;
    }

    bool eval_h(Index, const Number*, bool, Number factor, Index m, const Number* lambda, bool, Index, Index* rows,
                Index* columns, Number* values) override {
        const double sphere = program_.sphere_variables > 0 && values != nullptr ? 2.0 * lambda[m - 1] : 0.0;
        Index k = 0;
        for (Eigen::Index outer = 0; outer < lower_triangle_.outerSize(); ++outer) {
            for (Eigen::SparseMatrix<double>::InnerIterator entry(lower_triangle_, outer); entry; ++entry, ++k) {
                if (values == nullptr) {
                    rows[k] = static_cast<Index>(entry.row());
                    columns[k] = static_cast<Index>(entry.col());
                    continue;
                }
                const bool on_sphere = entry.row() == entry.col() && entry.row() < program_.sphere_variables;
                values[k] = factor * entry.value() + (on_sphere ? sphere : 0.0);
            }
        }
        return true;
    }

    bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number, Number, Number, Number,
                               Number, Number, Index, const Ipopt::IpoptData*,
                               Ipopt::IpoptCalculatedQuantities*) override {
        iterations_ = iteration;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
        timed_out_ = elapsed.count() > deadline_;  // wall time; Ipopt 3.11 only knows CPU time
        return !timed_out_ && !stop_requested();
    }

    void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                           const Number*, const Number*, Number, const Ipopt::IpoptData*,
                           Ipopt::IpoptCalculatedQuantities*) override {
        x_ = Eigen::Map<const Eigen::VectorXd>(x, n);
    }

private:
    const Program& program_;
    const Eigen::VectorXd& start_;
    double deadline_;
    Eigen::VectorXd x_;
    Eigen::SparseMatrix<double> lower_triangle_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    int iterations_ = 0;
    bool timed_out_ = false;
};

// A setter that meets an unknown option only prints and returns false.
template <typename Value>
void set_option(Ipopt::OptionsList& options, const char* name, const Value& value) {
    bool known = false;
    if constexpr (std::is_same_v<Value, double>) {
        known = options.SetNumericValue(name, value);
    } else if constexpr (std::is_same_v<Value, int>) {
        known = options.SetIntegerValue(name, value);
    } else {
        known = options.SetStringValue(name, std::string(value));
    }
    if (!known) {
        throw std::invalid_argument(std::string("Ipopt option ") + name +
                                    ": expected a name and value this version knows");
    }
}

}  // namespace

struct IpoptSolver::Implementation {
    SolverOptions options;
    Ipopt::SmartPtr<Ipopt::IpoptApplication> application;
};

namespace {

// Takes as long as a small solve.
Ipopt::SmartPtr<Ipopt::IpoptApplication> made_application(const SolverOptions& options) {
    Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);  // no console journal
    auto& list = *application->Options();
    set_option(list, "print_level", 0);
    set_option(list, "sb", "yes");
    set_option(list, "linear_solver", "mumps");
    set_option(list, "tol", options.tolerance);
    set_option(list, "max_iter", options.max_iterations);
    set_option(list, "max_cpu_time", options.time_limit);
    set_option(list, "bound_relax_factor", 0.0);  // otherwise bounds are violated by 1e-8
    set_option(list, "check_derivatives_for_naninf", "yes");
    set_option(list, "jac_c_constant", "no");
    set_option(list, "jac_d_constant", "yes");  // inequalities are linear
    set_option(list, "mu_strategy", "adaptive");
    set_option(list, "mu_oracle", "loqo");  // the default solves twice more an iteration, for no fewer of them
    // What follows saves a third of the time of small programs, in as many iterations: no refinement of a step and no
    // estimate of the first multipliers, each of which is one more solve, and small solves are all overhead; and, as
    // the programs are of order one, a first term of that order to make their Hessian positive.
    set_option(list, "fast_step_computation", "yes");
    set_option(list, "constr_mult_init_max", 0.0);
    set_option(list, "first_hessian_perturbation", 0.1);
    // An empty name keeps a file ipopt.opt in the working directory from changing any of this.
    if (application->Initialize("") != Ipopt::Solve_Succeeded) {
        throw std::runtime_error("Ipopt: initialisation failed");
    }
    return application;
}

}  // namespace

IpoptSolver::IpoptSolver(const SolverOptions& options) : implementation_(std::make_unique<Implementation>()) {
    const auto refuse = [](const char* what, double got) {
        throw std::invalid_argument(std::string(what) + ", got " + std::to_string(got));
    };
    if (!(options.tolerance > 0)) refuse("tolerance: expected > 0", options.tolerance);
    if (options.max_iterations < 0) refuse("max_iterations: expected >= 0", options.max_iterations);
    if (!(options.time_limit > 0)) refuse("time_limit: expected > 0 s", options.time_limit);
    implementation_->options = options;
}

IpoptSolver::~IpoptSolver() = default;
IpoptSolver::IpoptSolver(IpoptSolver&&) noexcept = default;
IpoptSolver& IpoptSolver::operator=(IpoptSolver&&) noexcept = default;

SolverOutcome IpoptSolver::solve(const Program& program, const Eigen::VectorXd& start) {
    validate(program, start);
    const auto begin = std::chrono::steady_clock::now();
    auto& application = implementation_->application;
    if (!Ipopt::IsValid(application)) {
        try {
            application = made_application(implementation_->options);
        } catch (const Ipopt::IpoptException&) {  // its word for no memory, which is no std::exception
            throw std::bad_alloc();
        }
    }
    auto* adapter = new Adapter(program, start, implementation_->options.time_limit);
    const Ipopt::SmartPtr<Ipopt::TNLP> owner(adapter);
    const auto status = application->OptimizeTNLP(owner);
    stop_point();
    if (status == Ipopt::Insufficient_Memory) throw std::bad_alloc();  // of the machine, not of the program
    SolverOutcome outcome;
    outcome.x = adapter->x();
    outcome.iterations = adapter->iterations();
    outcome.status = adapter->timed_out() ? "Time_Limit_Exceeded" : status_name(status);
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
}

std::string ipopt_version() { return IPOPT_VERSION; }

}  // namespace nsma
