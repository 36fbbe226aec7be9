#pragma once

#include "nsma/program/admissible_set.hpp"
#include "nsma/program/certificate.hpp"

namespace nsma {

struct ProveOptions {
    bool greatest = true;     ///< also prove an upper bound on the greatest energy
    bool chain = true;        ///< try the chain of partial sums before branch and bound
    int node_limit = 2'000;   ///< of branch and bound; 1: only its root
};

/// What could be proved of one pattern, and how far.
struct Proof {
    Certificate certificate;
    bool verdict_proved = false;  ///< trivial, empty or nonempty with E_min, exactly
    bool greatest_proved = false; ///< an upper bound of the energy is proved (unbounded: a ray)
    std::string unproved;         ///< one line: what is missing; empty when nothing is
    int nodes = 0;                ///< of branch and bound; 0 when the chain or the root decided
    double bound_gap = 0;         ///< energy_bound/energy_attained - 1, 0 when they are equal

    [[nodiscard]] bool exact_greatest() const;  ///< attained = bound, or unbounded
};

/// Writes the certificate of a pattern from the floating-point answer of its admissible set:
/// every number is recomputed in fractions on the active set found, and check() has the last
/// word, so that rounding can lose a proof but never forge one.
[[nodiscard]] Proof prove(const Kernel& kernel, const AdmissibleSet& set,
                          const ProveOptions& options = {});

}  // namespace nsma
