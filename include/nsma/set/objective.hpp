#pragma once

#include <optional>
#include <string_view>

namespace nsma {

/// What the program minimises over the orbits of one pattern at one energy level.
enum class Objective {
    least_shock,  ///< (1/E_unit) rho S dx sum (b_{n+1} - b_n)^2: the smoothest orbit
    nearest,      ///< energy of the difference to a given orbit over E_unit (continuation)
    least_force,  ///< largest |lambda| over the force unit Y S u/L
    min_energy,   ///< E/E_unit, no energy level
    max_energy    ///< -E/E_unit, no energy level; the value is reported as E/E_unit
};

/// Whether the energy itself is the objective, so that there is no energy level.
[[nodiscard]] constexpr bool is_extreme(Objective objective) {
    return objective == Objective::min_energy || objective == Objective::max_energy;
}

[[nodiscard]] std::string_view name(Objective objective);  ///< "least-shock", "nearest", ...
/// The objective of this name; absent for any other word.
[[nodiscard]] std::optional<Objective> objective_named(std::string_view name);

}  // namespace nsma
