#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "nsma/report/charts.hpp"
#include "gnuplot.hpp"

namespace nsma {
namespace {

const Pattern& pattern_of(const StoredOrbit& stored) { return stored.orbit.kernel.pattern; }

std::string orbit_label(const StoredOrbit& stored, const Bar& bar) {
    const Pattern& pattern = pattern_of(stored);
    return fmt::format("E{} = {:.3g}{}, T/τ = {:.4g} (r = {}, p = {})",
                       bar.gap_sign() == 0 ? "" : "/E_g", stored.energy,
                       bar.gap_sign() == 0 ? " J" : "", pattern.period_ratio(), pattern.free_steps,
                       pattern.contact_steps);
}

/// Wave that reaches the contact end during each step [m/s], read off the field.
std::vector<double> arriving_waves(const Orbit& orbit) {
    const Field motion = field(orbit);
    const Eigen::Index last = motion.velocity.rows() - 1;
    std::vector<double> waves;
    for (Eigen::Index n = 0; n < motion.velocity.cols(); ++n) {
        waves.push_back(
            (motion.velocity(last, n) - motion.stress(last, n) / orbit.bar.impedance()) / 2.0);
    }
    return waves;
}

}  // namespace

Chart orbit_chart(const StoredSweep& sweep, const OrbitChoice& choice) {
    static constexpr std::array<const char*, 3> styles{
        "dt 1 pt 7 lc rgb '#000000'", "dt 2 pt 4 lc rgb '#0072b2'", "dt 4 pt 9 lc rgb '#d55e00'"};
    const Bar& bar = sweep.scene.bar;
    const bool closed = bar.gap_sign() == 0;
    const double unit = closed ? 1.0 : bar.displacement_unit();
    double largest_force = 0.0;
    double lowest = closed ? 0.0 : bar.gap_sign();
    double longest = 0.0;
    for (const StoredOrbit* stored : choice.orbits) {
        largest_force = std::max(largest_force, contact_force(stored->orbit).cwiseAbs().maxCoeff());
        lowest = std::min(lowest, tip_displacement(stored->orbit).minCoeff() / unit);
        longest = std::max(longest, pattern_of(*stored).period_ratio());
    }
    const ScaledUnit force = scaled_unit(largest_force, "N");
    const ScaledUnit length = scaled_unit(std::abs(lowest), "m");
    const double shown = closed ? length.factor : 1.0 / unit;  // metres to what the axis shows
    const double wall = bar.gap * shown;
    lowest *= closed ? length.factor : 1.0;

    Chart chart{"orbits",
                fmt::format("# {}: t/tau, then tip displacement [{}] or contact force [{}]\n",
                            sweep.scene.title, closed ? length.unit : "x/|d|", force.unit),
                ""};
    std::string tips, forces;
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        const StoredOrbit& stored = *choice.orbits[i];
        const Pattern& pattern = pattern_of(stored);
        const Eigen::VectorXd tip = tip_displacement(stored.orbit);
        const Eigen::VectorXd push = contact_force(stored.orbit);
        chart.data += fmt::format("\n\n# tip-{}\n", i + 1);
        for (Eigen::Index n = 0; n < tip.size(); ++n) {
            chart.data +=
                fmt::format("{} {}\n", static_cast<double>(n) / pattern.cells, tip(n) * shown);
        }
        chart.data += fmt::format("\n\n# force-{}\n", i + 1);
        for (Eigen::Index n = 0; n < push.size(); ++n) {  // constant during a step
            for (const Eigen::Index end : {n, n + 1}) {
                chart.data += fmt::format("{} {}\n", static_cast<double>(end) / pattern.cells,
                                          push(n) * force.factor);
            }
        }
        const int every = std::max(1, pattern.period_steps() / 12);
        const auto curve = [&](const char* quantity, int interval, const std::string& title) {
            return fmt::format(
                "{}'orbits.dat' index '{}-{}' using 1:2 with linespoints lw 2 ps 0.7 pi {} {} {}",
                i == 0 ? "" : ", \\\n     ", quantity, i + 1, interval, styles[i], title);
        };
        tips += curve("tip", every, "title '" + orbit_label(stored, bar) + "'");
        forces += curve("force", 2 * every, "notitle");
    }
    const double head = 0.12 * (wall - lowest);
    chart.commands = fmt::format(
        "set multiplot\n"
        "set border 3 linecolor rgb '#333333'\nset xtics out nomirror\nset ytics out nomirror\n"
        "set lmargin screen 0.11\nset rmargin screen 0.97\nset xrange [0:{0}]\n"
        "set tmargin screen 0.93\nset bmargin screen 0.50\n"
        "set title {1} noenhanced\nset format x ''\nset ylabel '{2}' offset 0.5,0\nset yrange "
        "[{3}:{4}]\n"
        "set object 1 rectangle from graph 0, first {5} to graph 1, graph 1 behind fillcolor rgb "
        "'#dddddd' "
        "fillstyle solid border -1\n"
        "set label 1 'wall' at graph 0.5, first {6} center textcolor rgb '#333333'\n"
        "unset key\n"
        "plot {5} with lines lw 1.5 lc rgb '#333333' notitle, {7}\n"
        "unset object 1\nunset label 1\nunset title\n"
        "set tmargin screen 0.455\nset bmargin screen 0.235\n"
        "set format x '%g'\nset xlabel 'time t/τ'\nset ylabel 'contact force λ ({8})' offset "
        "0.5,0\n"
        "set yrange [{9}:{10}]\nset ytics autofreq\n"
        "set key at screen 0.54, screen 0.125 center top vertical maxrows 3 Left reverse samplen "
        "5\n"
        "plot 0 with lines lw 1 lc rgb '#999999' notitle, {11}",
        longest, gnuplot_text(fmt::format("{}: {}", sweep.scene.title, choice.what)),
        closed ? "tip displacement x (" + length.unit + ")" : "tip displacement x/|d|",
        lowest - head, wall + head, wall, wall + 0.5 * head, tips, force.unit,
        -1.15 * std::max(largest_force * force.factor, 1e-300),
        0.1 * std::max(largest_force * force.factor, 1e-300), forces);
    // The legend belongs to both panels: draw it once, below, with the curves of the second.
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        chart.commands += fmt::format(", \\\n     NaN with linespoints lw 2 ps 0.7 {} title '{}'",
                                      styles[i], orbit_label(*choice.orbits[i], bar));
    }
    chart.commands += "\nunset multiplot\n";
    return chart;
}

Chart space_time_chart(const StoredSweep& sweep, const StoredOrbit& stored) {
    const Orbit& orbit = stored.orbit;
    const Pattern& pattern = pattern_of(stored);
    const int cells = pattern.cells;
    const int steps = pattern.period_steps();
    const std::vector<double> waves = arriving_waves(orbit);
    // About 400 samples a period, the same number for each cell and each step.
    const int samples = std::clamp(400 / steps, 1, 8);
    const auto wave_at = [&](double when) {  // steps, may exceed the period
        const long n = static_cast<long>(std::floor(when));
        return waves[static_cast<std::size_t>(n % steps)];
    };
    const double impedance = orbit.bar.impedance();
    Eigen::MatrixXd stress(steps * samples, cells * samples);
    for (Eigen::Index row = 0; row < stress.rows(); ++row) {
        const double now = (static_cast<double>(row) + 0.5) / samples;
        for (Eigen::Index column = 0; column < stress.cols(); ++column) {
            // A quarter of a sample off the front keeps ties between equal distances apart.
            const double place = (static_cast<double>(column) + 0.25) / samples;
            stress(row, column) =
                -impedance * (wave_at(now + cells - place) + wave_at(now + cells + place));
        }
    }
    const double largest = stress.cwiseAbs().maxCoeff();
    const ScaledUnit unit = scaled_unit(largest, "Pa");

    Chart chart{
        "space-time",
        fmt::format("# {}: stress [{}]; rows: time, columns: place, {} samples a step and a cell\n",
                    sweep.scene.title, unit.unit, samples),
        ""};
    for (Eigen::Index row = 0; row < stress.rows(); ++row) {
        for (Eigen::Index column = 0; column < stress.cols(); ++column) {
            chart.data +=
                fmt::format("{}{:.6g}", column == 0 ? "" : " ", stress(row, column) * unit.factor);
        }
        chart.data += '\n';
    }
    const double period = pattern.period_ratio();
    const double release = static_cast<double>(pattern.free_steps) / cells;
    const double bound = std::max(largest * unit.factor, 1e-300);
    chart.commands = fmt::format(
        "set title {0}\n"
        "set xlabel 'place s/L'\nset ylabel 'time t/τ'\nset cblabel 'stress σ ({1}), tension > 0'\n"
        "set xrange [0:1]\nset yrange [0:{2}]\nset cbrange [{3}:{4}]\n"
        "set xtics out nomirror\nset ytics out nomirror\nset border 3 linecolor rgb "
        "'#333333'\nunset key\n"
        "set lmargin screen 0.10\nset rmargin screen 0.80\nset bmargin screen 0.13\nset tmargin "
        "screen 0.91\n"
        "# cividis: luminance grows steadily, so that grey print keeps the order\n"
        "set palette defined (0 '#00224e', 0.125 '#123570', 0.25 '#3b496c', 0.375 '#575d6d', 0.5 "
        "'#707173', "
        "0.625 '#8a8678', 0.75 '#a59c74', 0.875 '#c3b369', 1 '#fee838')\n"
        "set colorbox user origin screen 0.88, screen 0.13 size screen 0.025, screen 0.78\n"
        "set arrow 1 from graph 1.012, first {5} to graph 1.012, first {2} nohead lw 6 lc rgb "
        "'#000000'\n"
        "set label 1 'contact' at graph 1.035, first {6} center rotate by 90\n"
        "set label 2 'free' at graph 1.035, first {7} center rotate by 90 textcolor rgb '#555555'\n"
        "plot 'space-time.dat' matrix using (($1 + 0.5)*{8}):(($2 + 0.5)*{9}):3 with image\n",
        gnuplot_text(fmt::format("{}: {}", sweep.scene.title, orbit_label(stored, orbit.bar))),
        unit.unit, period, -bound, bound, release, (release + period) / 2.0, release / 2.0,
        1.0 / static_cast<double>(stress.cols()), period / static_cast<double>(stress.rows()));
    return chart;
}

}  // namespace nsma
