#pragma once

#include <optional>
#include <vector>

#include "nsma/orbit/pattern.hpp"

namespace nsma {

/// Exact nonsmooth modes of the continuous bar: mode k has
/// r = 2(k n_T - 2N), p = 4N - (2k-1) n_T and E/E_g = 1/(k^2 T/tau - (2k+1))^2.
/// Gap > 0: T from (2k+1) tau/k^2 (E -> infinity) up to 4 tau/(2k-1) (grazing); gap < 0: T from
/// 2 tau/k (E = E_g) up to (2k+1) tau/k^2; gap = 0: T = (2k+1) tau/k^2 at any energy.

/// Energy ratio E/E_g of mode k at period ratio T/tau. Throws std::invalid_argument for k < 1
/// or where the denominator is zero.
[[nodiscard]] double backbone_energy_ratio(int mode, double period_ratio);

/// Range of T/tau of mode k for a gap of the given sign; lo == hi for a closed gap.
struct PeriodInterval {
    double lo = 0.0;  ///< [tau]
    double hi = 0.0;  ///< [tau]
};
/// The periods at which mode k has orbits. Throws std::invalid_argument for k < 1 or a gap sign other than -1, 0, 1.
[[nodiscard]] PeriodInterval backbone_period_interval(int mode, int gap_sign);

/// Patterns of mode k on a mesh of N cells for a gap of the given sign (decided in integers,
/// r, p >= 1), ordered by n_T. May be empty on a coarse mesh.
[[nodiscard]] std::vector<Pattern> mode_patterns(int mode, int cells, int gap_sign);

/// The mode k whose formula gives this (r, p), if any.
[[nodiscard]] std::optional<int> mode_of(const Pattern& pattern);

}  // namespace nsma
