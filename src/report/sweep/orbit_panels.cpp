#include "orbit_panels.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/bar_text.hpp"

namespace nsma {

std::string orbit_label(const StoredOrbit& stored) {
    const Pattern& pattern = stored.orbit.kernel.pattern;
    const Bar& bar = stored.orbit.bar;
    const std::string steps = fmt::format("(r = {}, p = {})", pattern.free_steps, pattern.contact_steps);
    if (is_unit_bar(bar)) {
        return fmt::format("E{} = {:.3g}{}, T/τ = {:.4g} {}", bar.gap == 0 ? "" : "/E_g", stored.energy,
                           bar.gap == 0 ? " J" : "", pattern.period_ratio(), steps);
    }
    return fmt::format("E = {}, {} {}", si_text(stored.energy * bar.energy_unit(), "J"),
                       si_text(1.0 / period(stored.orbit), "Hz"), steps);
}

Extent extent_of(const OrbitChoice& choice, const Bar& bar) {
    Extent extent{.lowest = bar.gap};
    for (const StoredOrbit* stored : choice.orbits) {
        const Eigen::VectorXd tip = tip_displacement(stored->orbit);
        extent.force = std::max(extent.force, contact_force(stored->orbit).cwiseAbs().maxCoeff());
        extent.tip = std::max(extent.tip, tip.cwiseAbs().maxCoeff());
        extent.lowest = std::min(extent.lowest, tip.minCoeff());
        extent.period = std::max(extent.period, stored->orbit.kernel.pattern.period_ratio());
    }
    return extent;
}

const char* roman(std::size_t place) {
    static constexpr std::array<const char*, 3> numerals{"I", "II", "III"};
    return numerals.at(place);
}

std::string orbit_row(double time, double value, bool marked) {
    const double shown = value + 0.0;  // no negative zero
    return fmt::format("{} {} {}\n", time, shown, marked ? fmt::format("{}", shown) : "NaN");
}

std::string contact_shade(const Orbit& orbit, const Units& units, bool label) {
    const Pattern& pattern = orbit.kernel.pattern;
    const double step = orbit.mesh().time_step(orbit.bar) * units.time.factor;
    std::string text;
    for (int k = 0; k < periods_shown; ++k) {
        const double from = (k * pattern.period_steps() + pattern.free_steps) * step;
        const double to = (k + 1) * pattern.period_steps() * step;
        text += fmt::format(
            "set object rectangle from first {}, graph 0 to first {}, graph 1 behind fillcolor rgb '#e4e4e4' fillstyle "
            "solid noborder\n",
            from, to);
        if (label && k == 0)
            text += fmt::format(
                "set label 'contact' at first {}, graph 0.25 left offset 0.5,0 textcolor rgb '#333333'\n", to);
    }
    return text;
}

void draw_orbit(Panel& panel, const std::string& block, std::size_t place) {
    const CurveStyle& style = curve_styles.at(place);
    panel.curves.push_back({block + " using 1:2", fmt::format("lines lw 2 {}", style.line)});
    panel.curves.push_back({block + " using 1:3", fmt::format("points ps 0.8*mark pt {} {}", style.mark, style.line)});
}

namespace {

// In the key; several are numbered.
std::string orbit_name(const OrbitChoice& choice, std::size_t place) {
    const std::string label = orbit_label(*choice.orbits[place]);
    return choice.orbits.size() == 1 ? label : fmt::format("{}: {}", roman(place), label);
}

std::string tip_rows(const Orbit& orbit, const Units& units) {
    const Pattern& pattern = orbit.kernel.pattern;
    const Eigen::VectorXd tip = tip_displacement(orbit) * units.length.factor;
    const double step = orbit.mesh().time_step(orbit.bar) * units.time.factor;
    const int every = std::max(1, pattern.free_steps / 8);
    const int period = pattern.period_steps();
    std::string rows;
    for (int k = 0; k <= periods_shown * period; ++k) {
        const int n = k % period;
        rows += orbit_row(k * step, tip[n], n > 0 && n < pattern.free_steps && (n + every / 2) % every == 0);
    }
    return rows;
}

}  // namespace

Panel tip_panel(Chart& chart, const Scene& scene, const OrbitChoice& choice, const Frame& frame) {
    const Bar& bar = scene.bar;
    const Extent extent = extent_of(choice, bar);
    const Units units = units_of(bar, periods_shown * extent.period, extent.tip);
    const double at_wall = bar.gap * units.length.factor;
    const double head = 0.12 * std::max((bar.gap - extent.lowest) * units.length.factor, 1e-9);
    const double shown = periods_shown * extent.period * bar.travel_time() * units.time.factor;
    Panel panel{
        .frame = frame,
        .x = {units.time_label, range(0.0, shown), fmt::format("{} format '%g'", 1.0 / round_below(6.0 / shown))},
        .y = {units.tip_label, range(extent.lowest * units.length.factor - head, at_wall + head)},
        .key = fmt::format("at screen {}, screen {} center top vertical maxrows 3 samplen 4 font ',12'",
                           (frame.left + frame.right) / 2, frame.bottom - 0.155),
        .settings =
            (choice.orbits.size() == 1 ? contact_shade(choice.orbits.front()->orbit, units, false) : std::string()) +
            wall(at_wall, at_wall + 0.5 * head, "wall, x = d"),
        .curves = {{fmt::format("{}", at_wall), "lines lw 1.5 lc rgb '#333333'"}}};
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        const std::string rows = tip_rows(choice.orbits[i]->orbit, units);
        draw_orbit(panel, chart.add(fmt::format("tip-{}", i + 1), rows), i);
        panel.curves.push_back({"NaN", marked_line(curve_styles.at(i), 0.8), orbit_name(choice, i)});
    }
    return panel;
}

}  // namespace nsma
