#pragma once

#include <memory>
#include <optional>

#include "nsma/numerics/solver_options.hpp"
#include "nsma/set/admissible_set.hpp"
#include "nsma/proof/prove.hpp"
#include "nsma/search/answer.hpp"

namespace nsma {

class IpoptSolver;

/// Everything about one pattern that no energy level changes: its kernel and admissible set.
struct PatternProblem {
    Kernel kernel;
    AdmissibleSet set;
    Proof proof;                        ///< empty when proofs were not asked for
    Verdict verdict = Verdict::failed;  ///< trivial, inadmissible, admissible or failed
    std::optional<PatternKind> kind;    ///< of an admissible pattern
    EnergyInterval interval;            ///< exact where proved
};

struct PatternOptions {
    bool prove = true;  ///< certify the verdict, the kind and the energy interval in exact arithmetic
};

/// Decides one pattern for a gap of the given sign. Throws std::invalid_argument on a bad
/// pattern.
[[nodiscard]] PatternProblem pattern_problem(const Pattern& pattern, int gap_sign, const PatternOptions& options = {});

enum class SolverChoice {
    ipopt,
    nlopt,
    both,  ///< each against the other
    /// Until an answer is proved the best: the closed form where there is one (every simplex), else a polished segment
    /// point, NLopt, then both.
    proof
};

struct OrbitSolverOptions {
    SolverChoice solvers = SolverChoice::proof;
    /// Starts per solver while the optimum is not proved, >= 1; above 64 unknowns a quarter of them.
    int starts = 8;
    double agreement_tolerance = 1e-6;  ///< relative difference of objectives that still agree
    double raw_violation = 1e-4;        ///< a raw answer further out is a failure of its solver
    double level_tolerance = 1e-15;     ///< relative; a level further outside the interval has no orbit
    SolverOptions solver;
};

/// Whether Ipopt is asked at most levels, so that OrbitRequest::start saves time.
[[nodiscard]] bool ipopt_is_usual(const OrbitSolverOptions& options);

struct OrbitRequest {
    std::optional<double> level;  ///< E/E_unit, > 0; absent: the least-energy orbit
    Objective objective = Objective::least_shock;
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
    explicit OrbitSolver(const OrbitSolverOptions& options = {});
    ~OrbitSolver();
    OrbitSolver(OrbitSolver&&) noexcept;
    OrbitSolver& operator=(OrbitSolver&&) noexcept;

    /// Throws std::invalid_argument on a level that is not finite and > 0, a reference or start
    /// of a wrong size, or a problem made for another gap sign; any other failure is in the answer.
    [[nodiscard]] OrbitAnswer solve(const Bar& bar, const PatternProblem& problem, const OrbitRequest& request);

    /// Whether no orbit of such a pattern can have this energy, or none is known to: nothing is solved for it.
    [[nodiscard]] bool outside(const EnergyInterval& interval, double level) const;

private:
    OrbitSolverOptions options_;
    std::unique_ptr<IpoptSolver> ipopt_;
};

/// The window b_0..b_{2N-1} of an orbit in units u/dt, as a reference for `nearest`.
[[nodiscard]] Eigen::VectorXd reference_window(const Orbit& orbit);

}  // namespace nsma
