#pragma once

#include <array>
#include <string>

namespace nsma {

/// Uniform bar, fixed at s = 0; its end s = L faces a rigid wall across the gap d.
/// Displacement is positive toward the wall, stress positive in tension.
/// Source: [1] Fig. 1.
struct Bar {
    double length = 1.0;         ///< L [m], > 0
    double young_modulus = 1.0;  ///< Y [Pa], > 0
    double density = 1.0;        ///< rho [kg/m^3], > 0
    double area = 1.0;           ///< S [m^2], > 0
    double gap = 1.0;            ///< d [m]; < 0: prestressed against the wall, 0: closed

    [[nodiscard]] double wave_speed() const;   ///< c = sqrt(Y/rho) [m/s]
    [[nodiscard]] double impedance() const;    ///< z = rho c, per unit area [Pa s/m]
    [[nodiscard]] double travel_time() const;  ///< tau = L/c [s]
    [[nodiscard]] int gap_sign() const;        ///< delta = sign(d): -1, 0 or +1

    /// Unit of displacement of the nondimensional problem [m]: |d|, or for a closed gap the
    /// static stretch that stores one joule.
    [[nodiscard]] double displacement_unit() const;

    /// Unit of energy [J]: Y S d^2 / (2 L), the least energy with which the tip reaches the
    /// wall (or leaves it, d < 0); one joule for a closed gap.
    [[nodiscard]] double energy_unit() const;

    /// Unit of contact force [N]: Y S u / L with u the displacement unit.
    [[nodiscard]] double force_unit() const;
};

/// What a quantity of a bar may be, in SI units: more than any bar has, and little enough for all that is computed from
/// it to be a number.
struct BarQuantity {
    const char* name;    ///< as in a scene, with underscores
    double Bar::*value;  ///< the member of Bar
    double least;        ///< least value accepted [SI]
    double greatest;     ///< greatest value accepted [SI]
};
/// Every quantity of a bar that must be positive; the gap has bounds of its own.
inline constexpr std::array<BarQuantity, 4> bar_quantities{{{"length", &Bar::length, 1e-9, 1e6},
                                                            {"young_modulus", &Bar::young_modulus, 1e-3, 1e15},
                                                            {"density", &Bar::density, 1e-3, 1e9},
                                                            {"area", &Bar::area, 1e-18, 1e6}}};
/// Least size of a gap that is not zero [m].
inline constexpr double least_gap = 1e-15;
/// Greatest size of a gap [m].
inline constexpr double greatest_gap = 1e6;
/// What a gap is expected to be, in words.
[[nodiscard]] std::string gap_expected();

/// Throws std::invalid_argument (name, expected, got) unless every quantity is within its bounds.
void validate(const Bar& bar);

}  // namespace nsma
