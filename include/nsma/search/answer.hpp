#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "nsma/orbit/classification.hpp"
#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/orbit/replay.hpp"
#include "nsma/set/energy_interval.hpp"
#include "nsma/set/objective.hpp"

namespace nsma {

/// What is known of one pattern, or of one pattern at one energy level.
enum class Verdict {
    trivial,       ///< m = 0: only the bar at rest
    inadmissible,  ///< no orbit of this pattern meets COND1-3
    below,         ///< level below the least energy of the pattern
    above,         ///< level above the greatest energy of the pattern
    undecided,     ///< level between the greatest energy attained and the proved bound of it
    admissible,    ///< an orbit was found and its replay accepted
    failed         ///< none of the above could be established; the reason says why
};
/// "trivial", "inadmissible", ...
[[nodiscard]] std::string_view name(Verdict verdict);

/// One call of one solver from one start.
struct SolverRun {
    std::string name;      ///< "ipopt", "nlopt-slsqp", "nlopt-auglag"
    int start = 0;         ///< number of the start, 0-based; -1: OrbitRequest::start
    std::string status;    ///< the library's own word, e.g. "Solve_Succeeded", "XTOL_REACHED"
    bool usable = false;   ///< after polish, feasible by our own residuals
    double objective = 0;  ///< recomputed after polish; null in reports unless usable
    double violation = 0;  ///< largest constraint violation of the raw answer, recomputed
    int iterations = 0;    ///< of the library; of NLopt evaluations
    double seconds = 0;    ///< wall time of the call
};

/// The two solvers against each other.
enum class Agreement {
    not_needed,         ///< closed form, or an answer proved the best before a second solver
    agree,              ///< both usable, objectives within tolerance
    different_optimum,  ///< both usable, objectives differ
    one_failed,         ///< one answer is usable, the other is not
    both_failed,        ///< no answer is usable
    single              ///< only one solver was asked for, and it is usable
};
/// "not_needed", "agree", ...
[[nodiscard]] std::string_view name(Agreement agreement);

/// How far the kept orbit is known to be the best one. Objective values as reported.
struct Optimality {
    std::optional<double>
        lower_bound;          ///< proved: the closed form's own value, or weak duality in floating point; absent: none
    double gap = 0;           ///< (objective - lower_bound)/|objective|; meaningless without a bound
    bool global = false;      ///< gap within the agreement tolerance
    double kkt_residual = 0;  ///< relative, from our own multipliers; 0 for closed forms
};

/// An exact certificate of an orbit that was asked for: how far it may be from the best.
struct ExactProof {
    double gap = 0;            ///< relative_gap() that the certificate proves
    double check_seconds = 0;  ///< wall time of check()
    std::string certificate;   ///< one line, as `nsma check` reads it
};

/// The answer for one pattern, one objective and, unless the least-energy orbit is asked, one
/// energy level.
struct OrbitAnswer {
    Pattern pattern;                               ///< (N, r, p)
    int gap_sign = 1;                              ///< delta
    int kernel_dimension = 0;                      ///< m
    Verdict verdict = Verdict::failed;             ///< what is known of the level, of the pattern without one
    std::optional<PatternKind> kind;               ///< of an admissible pattern
    std::string reason;                            ///< one line; empty when there is nothing to say
    EnergyInterval interval;                       ///< energies of the pattern, in energy units
    bool verdict_proved = false;                   ///< by an exact certificate, or by the replayed orbit
    std::optional<Optimality> optimality;          ///< of the kept orbit
    std::optional<ExactProof> exact_proof;         ///< of the kept orbit, where it was asked for and found
    std::optional<double> level;                   ///< the level asked, in energy units
    Objective objective = Objective::least_shock;  ///< the one asked
    std::optional<double> objective_value;         ///< nondimensional, of the kept orbit
    Eigen::VectorXd reference;                     ///< `nearest`: the window it was measured against
    std::optional<double> objective_difference;    ///< relative gap between the two solvers
    std::string method;                            ///< "closed-form", "ipopt", "nlopt-slsqp", "segment"...
    std::optional<Orbit> orbit;                    ///< present if and only if the verdict is admissible
    std::optional<double> energy;                  ///< E/E_unit of the kept orbit
    std::optional<Replay> replay;                  ///< of the orbit found, kept or refused
    std::optional<Classification> classification;  ///< of the same orbit
    std::vector<SolverRun> solvers;                ///< the best run of each solver first, then the others
    Agreement agreement = Agreement::not_needed;   ///< of the two solvers
    double seconds = 0;                            ///< wall time of the whole answer
};

/// Whether the orbit of an answer is proved the best of its pattern at its level.
[[nodiscard]] inline bool proved_best(const OrbitAnswer& answer) {
    return answer.optimality && answer.optimality->global;
}
/// Whether that was proved without floating point.
[[nodiscard]] bool proved_exactly(const OrbitAnswer& answer);

}  // namespace nsma
