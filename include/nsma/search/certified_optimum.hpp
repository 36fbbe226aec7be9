#pragma once

#include <optional>
#include <string>

#include "nsma/check/certificate.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace nsma {

/// What could be proved of the best orbit of a pattern at one energy.
struct OptimumProof {
    std::optional<Certificate> certificate;  ///< of the pattern with its `optimum`, which check() accepts
    double gap = 0;                          ///< |value - bound|/value of it
    std::string unproved;                    ///< one line: why there is none
};

/// Certifies the best orbit of a contact motion at an energy inside its interval (`energy` = E/E_unit). Rounding may
/// lose the proof, never forge one: check() has the last word. Throws std::invalid_argument for another objective than
/// least_shock and least_force.
[[nodiscard]] OptimumProof certified_optimum(const PatternProblem& problem, Objective objective,
                                             const Rational& energy);

}  // namespace nsma
