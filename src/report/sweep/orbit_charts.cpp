#include <algorithm>

#include <fmt/format.h>

#include "orbit_panels.hpp"
#include "report/one_line.hpp"

namespace nsma {
namespace {

std::string force_rows(const Orbit& orbit, const Units& units, double factor) {
    const Pattern& pattern = orbit.kernel.pattern;
    const Eigen::VectorXd force = contact_force(orbit) * factor;
    const double step = orbit.mesh().time_step(orbit.bar) * units.time.factor;
    const int middle = pattern.free_steps + pattern.contact_steps / 2;
    const int period = pattern.period_steps();
    std::string rows;
    for (int k = 0; k < periods_shown * period; ++k) {  // constant during a step
        const int n = k % period;
        rows += orbit_row(k * step, force[n], n == middle) + orbit_row((k + 1) * step, force[n], false);
    }
    return rows + orbit_row(periods_shown * period * step, 0.0, false);  // the next flight begins
}

}  // namespace

Chart orbit_chart(const Scene& scene, const OrbitChoice& choice, const std::string& name) {
    const Extent extent = extent_of(choice, scene.bar);
    const Units units = units_of(scene.bar, periods_shown * extent.period, extent.tip);
    const ScaledUnit force = scaled_unit(extent.force, "N");
    const double largest_force = std::max(extent.force * force.factor, 1e-9);
    Chart chart{.name = name,
                .data = fmt::format("# {}: time [{}], then tip displacement [{}] or contact force [{}]; "
                                    "third column: where a marker stands\n",
                                    scene.title, units.time.unit, units.length.unit, force.unit),
                .settings = "set ylabel offset 0.5,0\n"};
    Panel tips = tip_panel(chart, scene, choice, {0.12, 0.97, 0.52, 0.92});
    tips.title = fmt::format("{}: {}", shortened(scene.title, 110), choice.what);
    Panel forces{
        .frame = Frame{0.12, 0.97, 0.26, 0.48},
        .x = tips.x,
        // The steps 1, 2, 5 are so closed under inversion that this is the least one with at most 4.5 a range.
        .y = {fmt::format("contact force λ ({})", force.unit), range(-1.15 * largest_force, 0.1 * largest_force),
              fmt::format("{}", 1.0 / round_below(4.5 / largest_force))},
        .settings =
            choice.orbits.size() == 1 ? contact_shade(choice.orbits.front()->orbit, units, true) : std::string(),
        .curves = {{"0", "lines lw 1 lc rgb '#999999'"}}};
    tips.x = {"", forces.x.range, "format ''"};  // time and key below serve both panels
    tips.key = "at screen 0.535, screen 0.14 center top vertical maxrows 3 samplen 5";
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        const std::string rows = force_rows(choice.orbits[i]->orbit, units, force.factor);
        draw_orbit(forces, chart.add(fmt::format("force-{}", i + 1), rows), i);
    }
    chart.panels = {std::move(tips), std::move(forces)};
    return chart;
}

}  // namespace nsma
