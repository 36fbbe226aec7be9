#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

#include "program.hpp"
#include "nsma/numerics/solver_options.hpp"

namespace nsma {

/// What a library answered, before anyone believed it.
struct SolverOutcome {
    Eigen::VectorXd x;   ///< last point; NaN if the library gave none; size n
    std::string status;  ///< the library's own word
    int iterations = 0;  ///< Ipopt iterations, NLopt evaluations
    double seconds = 0;  ///< wall time
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

enum class NloptMethod {
    slsqp,         ///< sequential quadratic programming
    auglag_lbfgs,  ///< augmented Lagrangian over L-BFGS
    auglag_slsqp,  ///< augmented Lagrangian over SLSQP
    cobyla,        ///< linear approximations without derivatives
    isres          ///< evolution strategy without derivatives, fixed seed
};

/// One call of NLopt. Throws like IpoptSolver::solve. ISRES searches a box: with a sphere, unknowns
/// without a bound get +-1.
[[nodiscard]] SolverOutcome solve_with_nlopt(NloptMethod method, const Program& program, const Eigen::VectorXd& start,
                                             const SolverOptions& options = {});

/// Versions of the libraries in use, e.g. "3.11.9".
[[nodiscard]] std::string ipopt_version();
[[nodiscard]] std::string nlopt_version();

}  // namespace nsma
