#include "nsma/wave/bar.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace nsma {

double Bar::wave_speed() const { return std::sqrt(young_modulus / density); }

double Bar::impedance() const { return density * wave_speed(); }

double Bar::travel_time() const { return length / wave_speed(); }

int Bar::gap_sign() const { return (gap > 0.0) - (gap < 0.0); }

double Bar::displacement_unit() const {
    if (gap != 0.0) {
        return std::abs(gap);
    }
    return std::sqrt(2.0 * length / (young_modulus * area));  // Y S u^2 / (2 L) = 1 J
}

double Bar::energy_unit() const { return gap != 0.0 ? 0.5 * young_modulus * area * gap * gap / length : 1.0; }

double Bar::force_unit() const { return young_modulus * area * displacement_unit() / length; }

std::string gap_expected() { return fmt::format("0 or a size from {:g} to {:g}", least_gap, greatest_gap); }

void validate(const Bar& bar) {
    for (const BarQuantity& quantity : bar_quantities) {
        const double value = bar.*quantity.value;
        if (value >= quantity.least && value <= quantity.greatest) continue;
        throw std::invalid_argument(fmt::format("{}: expected a number from {:g} to {:g}, got {}", quantity.name,
                                                quantity.least, quantity.greatest, value));
    }
    if (bar.gap == 0.0) return;
    if (!(std::abs(bar.gap) >= least_gap && std::abs(bar.gap) <= greatest_gap))
        throw std::invalid_argument(fmt::format("gap: expected {}, got {}", gap_expected(), bar.gap));
}

}  // namespace nsma
