#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sweep_charts.hpp"
#include "report/bar_text.hpp"

namespace nsma {
namespace {

constexpr int periods_shown = 2;

const Pattern& pattern_of(const StoredOrbit& stored) { return stored.orbit.kernel.pattern; }

std::string orbit_label(const StoredOrbit& stored) {
    const Pattern& pattern = pattern_of(stored);
    const Bar& bar = stored.orbit.bar;
    const std::string steps = fmt::format("(r = {}, p = {})", pattern.free_steps, pattern.contact_steps);
    if (is_unit_bar(bar)) {
        return fmt::format("E{} = {:.3g}{}, T/τ = {:.4g} {}", bar.gap == 0 ? "" : "/E_g", stored.energy,
                           bar.gap == 0 ? " J" : "", pattern.period_ratio(), steps);
    }
    const std::string ratio = bar.gap == 0 ? std::string() : fmt::format(" = {:.3g} E_g", stored.energy);
    return fmt::format("E = {}{}, {} {}", si_text(stored.energy * bar.energy_unit(), "J"), ratio,
                       si_text(1.0 / period(stored.orbit), "Hz"), steps);
}

/// What the axes of the orbits must show, in SI units.
struct Extent {
    double force = 0;
    double tip = 0;
    double lowest = 0;  ///< tip displacement
    double period = 0;  ///< T/tau
};

Extent extent_of(const OrbitChoice& choice, const Bar& bar) {
    Extent extent{.lowest = bar.gap};
    for (const StoredOrbit* stored : choice.orbits) {
        const Eigen::VectorXd tip = tip_displacement(stored->orbit);
        extent.force = std::max(extent.force, contact_force(stored->orbit).cwiseAbs().maxCoeff());
        extent.tip = std::max(extent.tip, tip.cwiseAbs().maxCoeff());
        extent.lowest = std::min(extent.lowest, tip.minCoeff());
        extent.period = std::max(extent.period, pattern_of(*stored).period_ratio());
    }
    return extent;
}

/// How times, lengths and forces are shown: in SI units with a prefix; of the unit bar in units of tau and |d|.
struct Units {
    ScaledUnit time, length;  ///< factors from seconds and metres
    std::string time_label, tip_label;
};

Units units_of(const Bar& bar, const Extent& extent) {
    const double period = extent.period * bar.travel_time();
    if (!is_unit_bar(bar)) {
        const Units units{scaled_unit(periods_shown * period, "s"), scaled_unit(extent.tip, "m"), {}, {}};
        return {units.time, units.length, fmt::format("time t ({})", units.time.unit),
                fmt::format("tip displacement x ({})", units.length.unit)};
    }
    const ScaledUnit time{1.0 / bar.travel_time(), "tau"};
    if (bar.gap == 0) {
        const ScaledUnit length = scaled_unit(extent.tip, "m");
        return {time, length, "time t/τ, τ = L/c", fmt::format("tip displacement x ({})", length.unit)};
    }
    return {time, {1.0 / std::abs(bar.gap), "|d|"}, "time t/τ, τ = L/c", "tip displacement x/|d|"};
}

/// A row of an orbit's block: time, value and, where a mark stands, the value again.
std::string orbit_row(double time, double value, bool marked) {
    const double shown = value + 0.0;  // no negative zero
    return fmt::format("{} {} {}\n", time, shown, marked ? fmt::format("{}", shown) : "NaN");
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

/// Panel settings that shade the contact phases of one orbit; the label stands in the first.
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

/// Stress [Pa] at places (columns) and times (rows) over one period.
Eigen::MatrixXd stress_picture(const Orbit& orbit) {
    const int cells = orbit.kernel.pattern.cells;
    const double period = orbit.kernel.pattern.period_ratio();
    const Eigen::VectorXd waves =
        orbit.kernel.waves(orbit.beta) * (orbit.bar.displacement_unit() / orbit.mesh().time_step(orbit.bar));
    const auto wave_at = [&](double when) {  // b_n [m/s]; in steps, may exceed the period
        return waves[static_cast<Eigen::Index>(std::floor(when)) % waves.size()];
    };
    // The same resolution in place and time, about 200 000 samples, a whole number of samples a
    // cell where it can be.
    const int wanted = static_cast<int>(std::clamp(std::sqrt(2e5 / period), 20.0, 400.0));
    const int columns = cells < wanted ? cells * ((wanted + cells - 1) / cells) : wanted;
    const int rows = static_cast<int>(std::clamp(std::round(columns * period), 2.0, 1000.0));
    Eigen::MatrixXd stress(rows, columns);
    for (int row = 0; row < rows; ++row) {
        const double now = (row + 0.5) * static_cast<double>(waves.size()) / rows;
        for (int column = 0; column < columns; ++column) {
            // Off the middle of a sample, so that no front passes exactly through a sample.
            const double place = (column + 0.25) * cells / columns;
            stress(row, column) =
                -orbit.bar.impedance() * (wave_at(now + cells - place) + wave_at(now + cells + place));
        }
    }
    return stress;
}

}  // namespace

Chart orbit_chart(const Scene& scene, const OrbitChoice& choice, const std::string& name) {
    const Bar& bar = scene.bar;
    const Extent extent = extent_of(choice, bar);
    const Units units = units_of(bar, extent);
    const ScaledUnit force = scaled_unit(extent.force, "N");
    const double at_wall = bar.gap * units.length.factor;
    const double head = 0.12 * std::max((bar.gap - extent.lowest) * units.length.factor, 1e-9);
    const double largest_force = std::max(extent.force * force.factor, 1e-9);
    const std::string times = range(0.0, periods_shown * extent.period * bar.travel_time() * units.time.factor);
    const bool alone = choice.orbits.size() == 1;
    const auto shade = [&](bool label) {
        return alone ? contact_shade(choice.orbits.front()->orbit, units, label) : std::string();
    };
    Panel tips{.frame = Frame{0.12, 0.97, 0.52, 0.92},
               .title = fmt::format("{}: {}", scene.title, choice.what),
               .x = {"", times, "format ''"},
               .y = {units.tip_label, range(extent.lowest * units.length.factor - head, at_wall + head)},
               .settings = shade(false) + wall(at_wall, at_wall + 0.5 * head, "wall, x = d"),
               .curves = {{fmt::format("{}", at_wall), "lines lw 1.5 lc rgb '#333333'"}}};
    Panel forces{
        .frame = Frame{0.12, 0.97, 0.26, 0.48},
        .x = {units.time_label, times, "format '%g'"},
        // The steps 1, 2, 5 are so closed under inversion that this is the least one with at most 4.5 a range.
        .y = {fmt::format("contact force λ ({})", force.unit), range(-1.15 * largest_force, 0.1 * largest_force),
              fmt::format("{}", 1.0 / round_below(4.5 / largest_force))},
        .key = "at screen 0.535, screen 0.14 center top vertical maxrows 3 samplen 5",
        .settings = shade(true),
        .curves = {{"0", "lines lw 1 lc rgb '#999999'"}}};
    Chart chart{.name = name,
                .data = fmt::format("# {}: time [{}], then tip displacement [{}] or contact force [{}]; "
                                    "third column: where a marker stands\n",
                                    scene.title, units.time.unit, units.length.unit, force.unit),
                .settings = "set ylabel offset 0.5,0\n"};
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        const Orbit& orbit = choice.orbits[i]->orbit;
        const CurveStyle& style = curve_styles.at(i);
        const auto draw = [&](Panel& panel, const char* quantity, const std::string& rows) {
            const std::string block = chart.add(fmt::format("{}-{}", quantity, i + 1), rows);
            panel.curves.push_back({block + " using 1:2", fmt::format("lines lw 2 {}", style.line)});
            panel.curves.push_back(
                {block + " using 1:3", fmt::format("points ps 0.8*mark pt {} {}", style.mark, style.line)});
        };
        draw(tips, "tip", tip_rows(orbit, units));
        draw(forces, "force", force_rows(orbit, units, force.factor));
        forces.curves.push_back({"NaN", marked_line(style, 0.8), orbit_label(*choice.orbits[i])});  // of both panels
    }
    chart.panels = {tips, forces};
    return chart;
}

Chart space_time_chart(const Scene& scene, const StoredOrbit& stored, const std::string& name) {
    const Pattern& pattern = pattern_of(stored);
    const double period = pattern.period_ratio();
    const double touch = static_cast<double>(pattern.free_steps) / pattern.cells;
    const Eigen::MatrixXd stress = stress_picture(stored.orbit);
    const double largest = stress.cwiseAbs().maxCoeff();
    const ScaledUnit unit = scaled_unit(largest, "Pa");
    Chart chart{.name = name,
                .data = fmt::format("# {}: stress [{}]; {} rows over one period, {} columns over the bar\n",
                                    scene.title, unit.unit, stress.rows(), stress.cols())};
    for (int row = 0; row < stress.rows(); ++row) {
        for (int column = 0; column < stress.cols(); ++column) {
            chart.data += fmt::format("{}{:.5g}", column == 0 ? "" : " ", stress(row, column) * unit.factor + 0.0);
        }
        chart.data += '\n';
    }
    chart.settings = fmt::format(
        R"(# compression blue, no stress white, tension brown; in grey both grow dark, compression more
set palette defined (0 '#08306b', 0.2 '#2b6cb0', 0.4 '#a9cce3', 0.5 '#ffffff', 0.6 '#f5d7a1', 0.8 '#d9822b', 1 '#a65414')
set colorbox user origin screen 0.865, screen 0.13 size screen 0.025, screen 0.78
set cblabel 'stress σ ({}), tension > 0' offset 1.2,0
set cbrange [-{bound}:{bound}]
set title enhanced
set arrow from graph 1.012, first {} to graph 1.012, first {} nohead lw 6 lc rgb '#000000'
)",
        unit.unit, touch, period, fmt::arg("bound", std::max(largest * unit.factor, 1e-9)));
    chart.panels = {
        {.frame = Frame{0.11, 0.77, 0.13, 0.91},
         .title = orbit_label(stored),
         .x = {"position s/L", "0:1", "('0, held end' 0, '0.2' 0.2, '0.4' 0.4, '0.6' 0.6, '0.8' 0.8, '1, wall' 1)"},
         .y = {"time t/τ, τ = L/c", range(0.0, period)},
         .settings = fmt::format("set label 'contact' at graph 1.03, first {} left\n"
                                 "set label 'free' at graph 1.03, first {} left textcolor rgb '#555555'\n",
                                 (touch + period) / 2.0, touch / 2.0),
         .curves = {{fmt::format("'{}.dat' matrix using (($1 + 0.5)*{}):(($2 + 0.5)*{}):3", name,
                                 1.0 / static_cast<double>(stress.cols()), period / static_cast<double>(stress.rows())),
                     "image"}}}};
    return chart;
}

std::vector<Chart> charts_of(const Scene& scene, const StoredOrbit& stored, const std::string& name) {
    const OrbitChoice choice{{&stored}, stored.level ? "one orbit" : "the orbit of least energy"};
    return {orbit_chart(scene, choice, name + "-motion"), space_time_chart(scene, stored, name + "-stress")};
}

}  // namespace nsma
