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

void validate(const Bar& bar) {
    const auto require_positive = [](const char* name, double value) {
        if (!std::isfinite(value) || value <= 0.0) {
            throw std::invalid_argument(fmt::format("{}: expected a finite value > 0, got {}", name, value));
        }
    };
    require_positive("length", bar.length);
    require_positive("young_modulus", bar.young_modulus);
    require_positive("density", bar.density);
    require_positive("area", bar.area);
    if (!std::isfinite(bar.gap)) {
        throw std::invalid_argument(fmt::format("gap: expected a finite value, got {}", bar.gap));
    }
    require_positive("wave_speed", bar.wave_speed());
    require_positive("impedance", bar.impedance());
    require_positive("travel_time", bar.travel_time());
    require_positive("displacement_unit", bar.displacement_unit());
    require_positive("energy_unit", bar.energy_unit());
    require_positive("force_unit", bar.force_unit());
}

}  // namespace nsma
