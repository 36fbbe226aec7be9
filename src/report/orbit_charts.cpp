#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "charts.hpp"
#include "gnuplot.hpp"

namespace nsma {
namespace {

const Pattern& pattern_of(const StoredOrbit& stored) { return stored.orbit.kernel.pattern; }

std::string orbit_label(const StoredOrbit& stored, const Bar& bar) {
    const Pattern& pattern = pattern_of(stored);
    return fmt::format("E{} = {:.3g}{}, T/τ = {:.4g} (r = {}, p = {})", bar.gap_sign() == 0 ? "" : "/E_g",
                       stored.energy, bar.gap_sign() == 0 ? " J" : "", pattern.period_ratio(), pattern.free_steps,
                       pattern.contact_steps);
}

/// The round step (1, 2 or 5 times a power of ten) that puts three to five ticks on 0..extent.
double tick_step(double extent) {
    const double power = std::pow(10.0, std::floor(std::log10(extent / 4.0)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (4.5 * factor * power >= extent) return factor * power;
    }
    return 10.0 * power;
}

/// Wave that reaches the contact end during each step [m/s], read off the field.
std::vector<double> arriving_waves(const Orbit& orbit) {
    const Field motion = field(orbit);
    const Eigen::Index last = motion.velocity.rows() - 1;
    std::vector<double> waves;
    for (Eigen::Index n = 0; n < motion.velocity.cols(); ++n) {
        waves.push_back((motion.velocity(last, n) - motion.stress(last, n) / orbit.bar.impedance()) / 2.0);
    }
    return waves;
}

}  // namespace

Chart orbit_chart(const StoredSweep& sweep, const OrbitChoice& choice) {
    static constexpr std::array<const char*, 3> lines{"dt 1 lc rgb '#000000'", "dt 2 lc rgb '#0072b2'",
                                                      "dt 4 lc rgb '#d55e00'"};
    static constexpr std::array<int, 3> marks{7, 5, 9};  // disc, square, triangle
    const Bar& bar = sweep.scene.bar;
    const bool closed = bar.gap_sign() == 0;
    double largest_force = 0.0, largest_tip = 0.0, lowest = bar.gap, longest = 0.0;
    for (const StoredOrbit* stored : choice.orbits) {
        const Eigen::VectorXd tip = tip_displacement(stored->orbit);
        largest_force = std::max(largest_force, contact_force(stored->orbit).cwiseAbs().maxCoeff());
        largest_tip = std::max(largest_tip, tip.cwiseAbs().maxCoeff());
        lowest = std::min(lowest, tip.minCoeff());
        longest = std::max(longest, pattern_of(*stored).period_ratio());
    }
    const ScaledUnit force = scaled_unit(largest_force, "N");
    const ScaledUnit length = closed ? scaled_unit(largest_tip, "m") : ScaledUnit{1.0 / bar.displacement_unit(), "|d|"};
    const double wall = bar.gap * length.factor;

    Chart chart{"orbits",
                fmt::format("# {}: time t/tau, then tip displacement [{}] or contact force [{}]; "
                            "third column: where a marker stands\n",
                            sweep.scene.title, length.unit, force.unit),
                ""};
    std::string tips, forces;
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        const StoredOrbit& stored = *choice.orbits[i];
        const Pattern& pattern = pattern_of(stored);
        const Eigen::VectorXd tip = tip_displacement(stored.orbit) * length.factor;
        const Eigen::VectorXd push = contact_force(stored.orbit) * force.factor;
        const Eigen::Index every = std::max(1, pattern.free_steps / 8);
        const Eigen::Index middle = pattern.free_steps + pattern.contact_steps / 2;
        const auto add = [&](Eigen::Index n, double value, bool marked) {
            chart.data += fmt::format("{} {} {}\n", static_cast<double>(n) / pattern.cells, value,
                                      marked ? fmt::format("{}", value) : "NaN");
        };
        chart.data += fmt::format("\n\n# tip-{}\n", i + 1);
        for (Eigen::Index n = 0; n < tip.size(); ++n) {
            add(n, tip(n) + 0.0, n > 0 && n < pattern.free_steps && (n + every / 2) % every == 0);
        }
        chart.data += fmt::format("\n\n# force-{}\n", i + 1);
        for (Eigen::Index n = 0; n < push.size(); ++n) {  // constant during a step
            add(n, push(n) + 0.0, n == middle);
            add(n + 1, push(n) + 0.0, false);
        }
        const auto curve = [&](const char* quantity) {
            const std::string source = fmt::format("'orbits.dat' index '{}-{}'", quantity, i + 1);
            return fmt::format(
                ", \\\n     {0} using 1:2 with lines lw 2 {1} notitle, \\\n     {0} using 1:3 with "
                "points ps 0.8*mark pt {2} {1} notitle",
                source, lines[i], marks[i]);
        };
        tips += curve("tip");
        forces += curve("force");
        // The legend belongs to both panels: it stands once, below, drawn with the second.
        forces += fmt::format(", \\\n     NaN with linespoints lw 2 ps 0.8*mark pt {} {} title '{}'", marks[i],
                              lines[i], orbit_label(stored, bar));
    }
    const double head = 0.12 * std::max((bar.gap - lowest) * length.factor, 1e-9);
    const double force_scale = std::max(largest_force * force.factor, 1e-9);
    chart.commands = fmt::format(
        R"(set multiplot
set border 3 linecolor rgb '#333333'
set xtics out nomirror
set ytics out nomirror
set lmargin screen 0.12
set rmargin screen 0.97
set xrange [0:{time}]
set tmargin screen 0.92
set bmargin screen 0.52
set title {title} noenhanced
set format x ''
set ylabel '{ylabel}' offset 0.5,0
set yrange [{lowest}:{top}]
set object 1 rectangle from graph 0, first {wall} to graph 1, graph 1 behind fillcolor rgb '#dddddd' fillstyle solid noborder
set label 1 'wall, x = d' at graph 0.5, first {label} center textcolor rgb '#333333'
unset key
plot {wall} with lines lw 1.5 lc rgb '#333333' notitle{tips}
unset object 1
unset label 1
unset title
set tmargin screen 0.48
set bmargin screen 0.26
set format x '%g'
set xlabel 'time t/τ, τ = L/c'
set ylabel 'contact force λ ({unit})' offset 0.5,0
set ytics {step}
set yrange [{pushed}:{slack}]
set key at screen 0.535, screen 0.14 center top vertical maxrows 3 Left reverse samplen 5
plot 0 with lines lw 1 lc rgb '#999999' notitle{forces}
unset multiplot
)",
        fmt::arg("time", 1.01 * longest),
        fmt::arg("title", gnuplot_text(fmt::format("{}: {}", sweep.scene.title, choice.what))),
        fmt::arg("ylabel",
                 closed ? fmt::format("tip displacement x ({})", length.unit) : std::string("tip displacement x/|d|")),
        fmt::arg("lowest", lowest * length.factor - head), fmt::arg("top", wall + head), fmt::arg("wall", wall),
        fmt::arg("label", wall + 0.5 * head), fmt::arg("tips", tips), fmt::arg("unit", force.unit),
        fmt::arg("step", tick_step(force_scale)), fmt::arg("pushed", -1.15 * force_scale),
        fmt::arg("slack", 0.1 * force_scale), fmt::arg("forces", forces));
    return chart;
}

Chart space_time_chart(const StoredSweep& sweep, const StoredOrbit& stored) {
    const Orbit& orbit = stored.orbit;
    const Pattern& pattern = pattern_of(stored);
    const int cells = pattern.cells;
    const int steps = pattern.period_steps();
    const std::vector<double> waves = arriving_waves(orbit);
    const auto wave_at = [&](double when) {  // in steps, may exceed the period
        const long n = static_cast<long>(std::floor(when));
        return waves[static_cast<std::size_t>(n % steps)];
    };
    // The same resolution in place and time, about 200 000 samples, a whole number of samples a
    // cell where it can be.
    const int wanted = static_cast<int>(std::clamp(std::sqrt(2e5 / pattern.period_ratio()), 20.0, 400.0));
    const int columns = cells < wanted ? cells * ((wanted + cells - 1) / cells) : wanted;
    const int rows = static_cast<int>(std::clamp(std::round(columns * pattern.period_ratio()), 2.0, 1000.0));
    const double impedance = orbit.bar.impedance();
    Eigen::MatrixXd stress(rows, columns);
    for (int row = 0; row < rows; ++row) {
        const double now = (row + 0.5) * steps / rows;
        for (int column = 0; column < columns; ++column) {
            // Off the middle of a sample, so that no front passes exactly through a sample.
            const double place = (column + 0.25) * cells / columns;
            stress(row, column) = -impedance * (wave_at(now + cells - place) + wave_at(now + cells + place));
        }
    }
    const double largest = stress.cwiseAbs().maxCoeff();
    const ScaledUnit unit = scaled_unit(largest, "Pa");

    Chart chart{"space-time",
                fmt::format("# {}: stress [{}]; {} rows over one period, {} columns over the bar\n", sweep.scene.title,
                            unit.unit, rows, columns),
                ""};
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            chart.data += fmt::format("{}{:.5g}", column == 0 ? "" : " ", stress(row, column) * unit.factor + 0.0);
        }
        chart.data += '\n';
    }
    const double period = pattern.period_ratio();
    const double touch = static_cast<double>(pattern.free_steps) / cells;
    const double bound = std::max(largest * unit.factor, 1e-9);
    chart.commands = fmt::format(
        R"(set title "{title}"
set xlabel 'position s/L'
set ylabel 'time t/τ, τ = L/c'
set cblabel 'stress σ ({unit}), tension > 0' offset 1.2,0
set xrange [0:1]
set yrange [0:{period}]
set cbrange [-{bound}:{bound}]
set xtics out nomirror
set ytics out nomirror
set border 3 linecolor rgb '#333333'
unset key
set lmargin screen 0.11
set rmargin screen 0.77
set bmargin screen 0.13
set tmargin screen 0.91
# cividis: its luminance grows steadily, so that grey print keeps the order
set palette defined (0 '#00224e', 0.125 '#123570', 0.25 '#3b496c', 0.375 '#575d6d', 0.5 '#707173', 0.625 '#8a8678', 0.75 '#a59c74', 0.875 '#c3b369', 1 '#fee838')
set colorbox user origin screen 0.865, screen 0.13 size screen 0.025, screen 0.78
set arrow 1 from graph 1.012, first {touch} to graph 1.012, first {period} nohead lw 6 lc rgb '#000000'
set label 1 'contact' at graph 1.03, first {contact} left
set label 2 'free' at graph 1.03, first {free} left textcolor rgb '#555555'
plot 'space-time.dat' matrix using (($1 + 0.5)*{width}):(($2 + 0.5)*{height}):3 with image
)",
        fmt::arg("title", orbit_label(stored, orbit.bar)), fmt::arg("unit", unit.unit), fmt::arg("period", period),
        fmt::arg("bound", bound), fmt::arg("touch", touch), fmt::arg("contact", (touch + period) / 2.0),
        fmt::arg("free", touch / 2.0), fmt::arg("width", 1.0 / columns), fmt::arg("height", period / rows));
    return chart;
}

}  // namespace nsma
