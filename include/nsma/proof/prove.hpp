#pragma once

#include "nsma/set/admissible_set.hpp"
#include "nsma/check/certificate.hpp"

namespace nsma {

/// What could be proved of one pattern.
struct Proof {
    Certificate certificate;      ///< check() accepts what it claims, if `verdict_proved`
    bool verdict_proved = false;  ///< trivial, empty or nonempty with its kind and E_min, exactly
    std::string unproved;         ///< one line: what is missing; empty when nothing is

    [[nodiscard]] bool exact_greatest() const;  ///< attained = bound, or unbounded
};

/// Writes the certificate of a pattern from its admissible set: every number is recomputed in fractions, and check()
/// has the last word, so that rounding can lose a proof but never forge one.
[[nodiscard]] Proof prove(const Kernel& kernel, const AdmissibleSet& set);

}  // namespace nsma
