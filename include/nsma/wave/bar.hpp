#pragma once

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

/// Throws std::invalid_argument (name, expected, got) unless every quantity is finite, the
/// first four are > 0 and the derived quantities above are finite and > 0.
void validate(const Bar& bar);

}  // namespace nsma
