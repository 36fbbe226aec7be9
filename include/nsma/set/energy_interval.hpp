#pragma once

#include <optional>
#include <string>

namespace nsma {

/// The interval of attainable energies of a pattern, in units of the bar's energy unit. With a
/// proof these are the exact fractions, rounded once.
struct EnergyInterval {
    std::optional<double> least;     ///< E_min; absent when the pattern is not admissible
    std::optional<double> greatest;  ///< greatest energy attained; absent when unbounded or unknown
    std::optional<double> bound;     ///< proved upper bound of the energy; absent when there is none
    bool unbounded = false;          ///< no greatest energy
    std::string least_exact;         ///< "12/11"; empty without a proof
    std::string greatest_exact;      ///< of the greatest energy; empty without a proof or when unbounded
};

}  // namespace nsma
