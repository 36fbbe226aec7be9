#pragma once

#include "nsma/orbit/orbit.hpp"

namespace nsma {

/// What an experiment would measure of an orbit, in SI units.
struct PhysicalValues {
    double frequency = 0;     ///< 1/T [Hz]
    double peak_force = 0;    ///< largest force with which the bar presses against the wall [N], >= 0
    double impact_speed = 0;  ///< tip speed just before contact [m/s], >= 0: 2|b_n| of the last free step with b_n != 0
    double peak_stress = 0;   ///< largest |stress| over bar and period [Pa]: 2 z max|b_n|, at the fixed end
    double tip_least = 0;     ///< least tip displacement over the period [m]: farthest from the wall
};

/// Waves below 1e-9 of the largest one count as zero, as in classify().
[[nodiscard]] PhysicalValues physical_values(const Orbit& orbit);

}  // namespace nsma
