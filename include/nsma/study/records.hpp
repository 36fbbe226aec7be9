#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "nsma/search/answer.hpp"

namespace nsma {

/// One pattern as the scan sees it.
struct PatternRecord {
    Pattern pattern;                    ///< (N, r, p)
    int gap_sign = 1;                   ///< delta
    int kernel_dimension = 0;           ///< m
    Verdict verdict = Verdict::failed;  ///< trivial, inadmissible, admissible or failed
    std::optional<PatternKind> kind;    ///< of an admissible pattern
    EnergyInterval interval;            ///< in energy units
    bool proved = false;                ///< the verdict, the kind and E_min by an exact certificate
    std::string reason;                 ///< what decided, and what could not be proved
    double seconds = 0;                 ///< wall time
};

/// Counts and times of a whole sweep.
struct SweepSummary {
    int patterns = 0;                               ///< visited
    int trivial = 0;                                ///< m = 0
    int inadmissible = 0;                           ///< no orbit
    int admissible = 0;                             ///< some orbit
    std::array<int, pattern_kinds.size()> kinds{};  ///< admissible ones by PatternKind
    int left = 0;             ///< admissible ones that were not solved: free and stuck ones, unless all kinds are asked
    int failed_patterns = 0;  ///< not decided: too many unknowns
    int unproved = 0;         ///< patterns whose verdict has no exact proof
    int open_bounds = 0;      ///< admissible patterns whose greatest energy is not exact
    int levels = 0;           ///< pattern-level pairs asked, closed-form least-energy orbits aside
    int solved = 0;           ///< admissible answers among them
    int copies = 0;           ///< solved ones whose motion an earlier answer at the level has under another label
    int closed_form = 0;      ///< solved in closed form, or proved the best before a second solver was asked
    int below = 0;            ///< levels below the least energy
    int above = 0;            ///< levels above the greatest energy
    int undecided = 0;        ///< levels between the greatest energy attained and its proved bound
    int global = 0;           ///< solved ones proved to be the best orbit at their level
    int proved_exactly = 0;   ///< solved ones whose certificate proves it
    int certificates = 0;     ///< of orbits, least-energy ones with them
    std::int64_t certificate_bytes = 0;  ///< their size
    double check_seconds = 0;            ///< wall time of checking them
    double worst_gap = 0;                ///< largest relative gap to the proved bound among the other solved ones
    int agreed = 0;                      ///< usable answers of both solvers at one optimum
    int disagreed = 0;                   ///< usable answers of both solvers at different optima
    int one_failed = 0;                  ///< one of the two solvers failed; the other's answer was kept
    int failed = 0;                      ///< verdict `failed`, or both solvers failed
    double worst_violation = 0;          ///< worst replayed relative violation of the kept orbits
    double seconds = 0;                  ///< wall time
    bool interrupted = false;            ///< ended before its last pattern
};

}  // namespace nsma
