#include "orbit_units.hpp"

#include <cmath>

#include <fmt/format.h>

#include "bar_text.hpp"

namespace nsma {

Units units_of(const Bar& bar, double duration, double largest_tip) {
    if (!is_unit_bar(bar)) {
        const Units units{scaled_unit(duration * bar.travel_time(), "s"), scaled_unit(largest_tip, "m"), {}, {}};
        return {units.time, units.length, fmt::format("time t ({})", units.time.unit),
                fmt::format("tip displacement x ({})", units.length.unit)};
    }
    const ScaledUnit time{1.0 / bar.travel_time(), "tau"};
    if (bar.gap == 0) {
        const ScaledUnit length = scaled_unit(largest_tip, "m");
        return {time, length, "time t/τ, τ = L/c", fmt::format("tip displacement x ({})", length.unit)};
    }
    return {time, {1.0 / std::abs(bar.gap), "|d|"}, "time t/τ, τ = L/c", "tip displacement x/|d|"};
}

}  // namespace nsma
