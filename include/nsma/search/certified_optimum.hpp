#pragma once

#include <optional>
#include <string>

#include "nsma/check/certificate.hpp"
#include "nsma/search/answer.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace nsma {

/// What could be proved of an orbit.
struct OptimumProof {
    std::optional<Certificate> certificate;  ///< of the pattern with its `optimum`, which check() accepts
    double gap = 0;                          ///< relative_gap() of it
    double check_seconds = 0;                ///< wall time of check()
    std::string unproved;                    ///< one line: why there is none
};

/// Certifies that the orbit of an answer is the best of its pattern at its level, or how far it may be from it; of an
/// answer without a level the certificate of the pattern, which says the ends of the energy interval. Orbits are
/// rounded to 10 digits, and so is the reference of `nearest`, of which its part in the kernel counts. Rounding may
/// lose the proof, never forge one: check() has the last word. Free patterns have none.
[[nodiscard]] OptimumProof certified_optimum(const PatternProblem& problem, const OrbitAnswer& answer);

}  // namespace nsma
