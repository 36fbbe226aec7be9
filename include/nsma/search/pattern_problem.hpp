#pragma once

#include <optional>

#include "nsma/orbit/kernel.hpp"
#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/set/admissible_set.hpp"
#include "nsma/proof/prove.hpp"
#include "nsma/search/answer.hpp"

namespace nsma {

/// Amplitudes left after reduction beyond which a pattern is not solved: memory grows with their square.
inline constexpr int max_unknowns = 10'000;

/// Everything about one pattern that no energy level changes: its kernel and admissible set.
struct PatternProblem {
    Kernel kernel;                       ///< of the pattern
    AdmissibleSet set;                   ///< for a gap of the sign asked
    Proof proof;                         ///< empty when proofs were not asked for
    Verdict verdict = Verdict::trivial;  ///< trivial, inadmissible or admissible; failed: too many unknowns
    std::optional<PatternKind> kind;     ///< of an admissible pattern
    EnergyInterval interval;             ///< exact where proved
};

/// What pattern_problem() does beyond deciding.
struct PatternOptions {
    bool prove = true;  ///< certify the verdict, the kind and the energy interval in exact arithmetic
};

/// Decides one pattern for a gap of the given sign. Throws std::invalid_argument on a bad
/// pattern.
[[nodiscard]] PatternProblem pattern_problem(const Pattern& pattern, int gap_sign, const PatternOptions& options = {});

}  // namespace nsma
