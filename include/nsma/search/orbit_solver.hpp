#pragma once

#include <memory>
#include <optional>

#include "nsma/numerics/solver_options.hpp"
#include "nsma/search/answer.hpp"

namespace nsma {

class IpoptSolver;
struct PatternProblem;

/// Relative difference of objectives that still agree.
inline constexpr double agreement_tolerance = 1e-6;

/// Which solvers take part where no closed form proves the optimum.
enum class SolverChoice {
    ipopt,  ///< Ipopt alone
    nlopt,  ///< NLopt alone
    both,   ///< each against the other
    /// Until an answer is proved the best: the closed form where there is one (every simplex), else a polished segment
    /// point, NLopt, then both.
    proof
};

/// How hard a solver tries.
struct OrbitSolverOptions {
    SolverChoice solvers = SolverChoice::proof;  ///< which of them
    /// Starts per solver while the optimum is not proved, >= 1; above 64 unknowns a quarter of them.
    int starts = 8;
    double raw_violation = 1e-4;  ///< a raw answer further out is a failure of its solver
    SolverOptions solver;         ///< limits of each call
};

/// Whether Ipopt runs at most levels, so that OrbitRequest::start saves time.
[[nodiscard]] bool ipopt_is_usual(const OrbitSolverOptions& options);

/// Which orbit of a pattern is wanted.
struct OrbitRequest {
    std::optional<double> level;                   ///< E/E_unit, > 0; absent: the least-energy orbit
    Objective objective = Objective::least_shock;  ///< which orbit of the level
    /// `nearest`: window b_0..b_{2N-1} in units u/dt; empty: the least-energy orbit (closed gap:
    /// the least-shock orbit at the level).
    Eigen::VectorXd reference{};
    /// Beta of an orbit of this pattern at a level nearby, from which Ipopt starts; empty: from a point of the level.
    Eigen::VectorXd start{};
};

/// Finds, cross-checks and replays orbits of one bar, reusing its solvers. Closed forms first:
/// a point, a segment, an end of the energy interval never reach a solver.
class OrbitSolver {
public:
    /// Makes the solvers, for any number of answers. Throws std::invalid_argument for starts < 1.
    explicit OrbitSolver(const OrbitSolverOptions& options = {});
    ~OrbitSolver();
    /// Takes the solvers over; what is left may only be assigned to or destroyed.
    OrbitSolver(OrbitSolver&&) noexcept;
    /// Takes the solvers over, likewise.
    OrbitSolver& operator=(OrbitSolver&&) noexcept;

    /// The best orbit found, or why there is none; one solver a process, never threads. Throws std::invalid_argument on
    /// a level that is not finite and > 0, a reference or start of a wrong size, or a problem made for another gap
    /// sign; any other failure is in the answer.
    [[nodiscard]] OrbitAnswer solve(const Bar& bar, const PatternProblem& problem, const OrbitRequest& request);

private:
    OrbitSolverOptions options_;
    std::unique_ptr<IpoptSolver> ipopt_;
};

/// Whether no orbit of such a pattern can have this energy, or none is known to: nothing is solved for it.
[[nodiscard]] bool outside(const EnergyInterval& interval, double level);

/// The window b_0..b_{2N-1} of an orbit in units u/dt, as a reference for `nearest`.
[[nodiscard]] Eigen::VectorXd reference_window(const Orbit& orbit);

}  // namespace nsma
