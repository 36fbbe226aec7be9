#include "bar_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include "chart.hpp"
#include "nsma/orbit/backbone.hpp"

namespace nsma {
namespace {

constexpr int most_cells_tried = 2000;
constexpr double largest_strain = 0.01;
constexpr double largest_stress = 1e10;  // Pa; a tenth of the strongest fibres' modulus
constexpr double slowest_sound = 20;     // m/s; soft rubber has some 30
constexpr double fastest_sound = 3e4;    // m/s; diamond has 18,000

}  // namespace

bool is_unit_bar(const Bar& bar) {
    return bar.length == 1 && bar.young_modulus == 1 && bar.density == 1 && bar.area == 1;
}

std::string si_text(double value, const std::string& unit) {
    const ScaledUnit scaled = scaled_unit(std::abs(value), unit);
    return fmt::format("{:.5g} {}", value * scaled.factor, scaled.unit);
}

std::string derived_text(const Scene& scene) {
    const Bar& bar = scene.bar;
    std::string text = fmt::format("bar: c = {}, tau = L/c = {}, f_1 = c/4L = {}", si_text(bar.wave_speed(), "m/s"),
                                   si_text(bar.travel_time(), "s"), si_text(0.25 / bar.travel_time(), "Hz"));
    if (bar.gap != 0)
        text += fmt::format(", E_g = {}, d/L = {:.3g}", si_text(bar.energy_unit(), "J"), bar.gap / bar.length);
    if (const auto* mode = std::get_if<ModeSelection>(&scene.patterns)) {
        const auto patterns = mode_patterns(mode->mode, scene.mesh.cells, bar.gap_sign());
        text += fmt::format("; mode {} has {} {} on {} cells", mode->mode, patterns.size(),
                            patterns.size() == 1 ? "frequency" : "frequencies", scene.mesh.cells);
        int cells = scene.mesh.cells;
        while (patterns.empty() && cells < most_cells_tried &&
               mode_patterns(mode->mode, ++cells, bar.gap_sign()).empty()) {
        }
        if (patterns.empty() && cells < most_cells_tried)
            text += fmt::format(", {} cells are the fewest with one", cells);
    }
    return text;
}

std::vector<std::string> doubts(const Scene& scene) {
    const Bar& bar = scene.bar;
    if (is_unit_bar(bar)) return {};
    std::vector<std::string> found;
    const double strain = std::abs(bar.gap) / bar.length;
    if (strain > largest_strain) {
        found.push_back(
            fmt::format("strain d/L = {:.3g} % is more than a linear bar bears; is the gap in metres?", 100 * strain));
    }
    if (const double stress = strain * bar.young_modulus; stress > largest_stress) {
        found.push_back(
            fmt::format("stress Y d/L = {} is more than any solid bears; are gap and length in metres, the "
                        "modulus in pascals?",
                        si_text(stress, "Pa")));
    }
    if (const double c = bar.wave_speed(); c < slowest_sound || c > fastest_sound) {
        found.push_back(
            fmt::format("wave speed {} is that of no solid; is the modulus in pascals (1 GPa = 1e9), the "
                        "density in kg/m^3?",
                        si_text(c, "m/s")));
    }
    return found;
}

}  // namespace nsma
