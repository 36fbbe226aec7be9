#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

#include "nsma/program/program.hpp"

namespace nsma {

struct SolverOptions {
    double tolerance = 1e-8;    ///< relative stopping tolerance handed to the library; polish does the rest
    int max_iterations = 150;   ///< Ipopt iterations; NLopt evaluations are 10 times this
    double time_limit = 10.0;   ///< seconds a call
};

/// What a library answered, before anyone believed it.
struct SolverOutcome {
    Eigen::VectorXd x;    ///< last point; NaN if the library gave none; size n
    std::string status;   ///< the library's own word
    int iterations = 0;   ///< Ipopt iterations, NLopt evaluations
    double seconds = 0;   ///< wall time
};

/// Interior point method of Ipopt with exact first and second derivatives. One object serves
/// many solves. Not for use from several threads at once: its linear solver is not reentrant.
class IpoptSolver {
public:
    explicit IpoptSolver(const SolverOptions& options = {});
    ~IpoptSolver();
    IpoptSolver(IpoptSolver&&) noexcept;
    IpoptSolver& operator=(IpoptSolver&&) noexcept;

    /// Throws std::invalid_argument on a program or start that does not validate, or an option
    /// the library does not know; any other failure is a status.
    [[nodiscard]] SolverOutcome solve(const Program& program, const Eigen::VectorXd& start);

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Has the process keep memory that was freed (up to 64 MB, with glibc). Ipopt's linear solver takes and gives back its own
/// in every iteration, NLopt's L-BFGS in every call; fresh pages take longer than their work. For the start of a program;
/// concerns all of it.
void keep_freed_memory();

enum class NloptMethod {
    slsqp,         ///< sequential quadratic programming
    auglag_lbfgs,  ///< augmented Lagrangian over L-BFGS
    auglag_slsqp,  ///< augmented Lagrangian over SLSQP
    cobyla,        ///< linear approximations without derivatives
    isres          ///< evolution strategy without derivatives, fixed seed
};

/// One call of NLopt. Throws like IpoptSolver::solve. ISRES searches a box: with a sphere, unknowns
/// without a bound get +-1.
[[nodiscard]] SolverOutcome solve_with_nlopt(NloptMethod method, const Program& program,
                                             const Eigen::VectorXd& start,
                                             const SolverOptions& options = {});

/// Versions of the libraries in use, e.g. "3.11.9".
[[nodiscard]] std::string ipopt_version();
[[nodiscard]] std::string nlopt_version();

}  // namespace nsma
