#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "nsma/orbit/backbone.hpp"
#include "report/charts.hpp"
#include "report/gnuplot.hpp"

namespace nsma {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int most_modes = 30;

struct Range {
    double lo = infinity;
    double hi = -infinity;

    void add(double value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    [[nodiscard]] bool empty() const { return lo > hi; }
};

/// Energies (> 0) and frequencies that the axes must show.
struct Axes {
    Range energy;
    Range frequency;
};

/// The axes hold every single orbit, every start of an interval and every level; of the ends of
/// intervals only those within a decade of the rest, lest one long interval squeeze the others.
Axes axes_of(const StoredSweep& sweep) {
    Axes axes;
    const auto add = [](Range& range, double value) {
        if (std::isfinite(value) && value > 0.0) range.add(value);
    };
    for (const PatternRecord& record : sweep.patterns) {
        if (record.verdict != Verdict::admissible) continue;
        axes.frequency.add(record.pattern.frequency_ratio());
        if (record.interval.least) add(axes.energy, *record.interval.least);
    }
    for (const StoredLevel& level : sweep.levels) {
        if (level.verdict == Verdict::admissible && level.energy) add(axes.energy, *level.energy);
    }
    for (const double level : sweep.scene.levels) add(axes.energy, level);
    Range ends;
    for (const PatternRecord& record : sweep.patterns) {
        if (record.verdict == Verdict::admissible && record.interval.greatest) add(ends, *record.interval.greatest);
    }
    if (!ends.empty()) axes.energy.add(std::min(ends.hi, 10.0 * axes.energy.hi));
    for (const PatternRecord& record : sweep.patterns) {
        if (axes.frequency.empty()) axes.frequency.add(record.pattern.frequency_ratio());
    }
    if (axes.frequency.empty()) axes.frequency.add(1.0);
    if (axes.energy.empty()) axes.energy.add(1.0);

    axes.energy.lo /= 1.5;
    axes.energy.hi *= 1.5;
    const double spread = axes.frequency.hi - axes.frequency.lo;
    // The linear frequency that a branch starts from belongs in the picture when it is near.
    for (const double nearest : {std::floor(axes.frequency.lo), std::ceil(axes.frequency.hi)}) {
        const double distance = std::max(axes.frequency.lo - nearest, nearest - axes.frequency.hi);
        if (nearest >= 1.0 && distance < 0.35 * spread) axes.frequency.add(nearest);
    }
    const double margin = spread > 0.0 ? std::max(0.04, 0.06 * spread) : 0.4;
    axes.frequency.lo = std::max(0.0, axes.frequency.lo - margin);
    axes.frequency.hi += std::max(margin, 0.12 * spread);  // room for a branch that begins there
    return axes;
}

/// Energy and frequency along the exact mode k, within the axes' energies; empty out of range.
std::vector<std::pair<double, double>> backbone(int mode, int gap_sign, const Axes& axes) {
    const PeriodInterval periods = backbone_period_interval(mode, gap_sign);
    std::vector<std::pair<double, double>> points;
    const auto add = [&](double energy, double period) {
        const double frequency = 4.0 / period;
        if (frequency >= axes.frequency.lo && frequency <= axes.frequency.hi) points.emplace_back(energy, frequency);
    };
    if (gap_sign == 0) {
        add(axes.energy.lo, periods.lo);
        add(axes.energy.hi, periods.lo);
        return points;
    }
    const double least = backbone_energy_ratio(mode, gap_sign > 0 ? periods.hi : periods.lo);
    const double limit = (2.0 * mode + 1.0) / (1.0 * mode * mode);  // T/tau as E -> infinity
    constexpr int pieces = 400;
    for (int i = 0; i <= pieces && least < axes.energy.hi; ++i) {
        const double energy = least * std::pow(axes.energy.hi / least, static_cast<double>(i) / pieces);
        const double period = limit + gap_sign / (std::sqrt(energy) * mode * mode);
        if (energy >= axes.energy.lo) add(energy, period);
    }
    return points;
}

/// A named block of the data file; gnuplot finds it by its name.
struct Block {
    std::string name;
    std::string rows;

    void add(double x, double y) { rows += fmt::format("{} {}\n", x, y); }
    void add(double x, double y, double z) { rows += fmt::format("{} {} {}\n", x, y, z); }
    void gap() { rows += "\n"; }
};

}  // namespace

Chart frequency_energy_chart(const StoredSweep& sweep) {
    const Axes axes = axes_of(sweep);
    const int gap_sign = sweep.scene.bar.gap_sign();
    Block exact{"exact-modes", ""}, linear_free{"linear-free-fixed", ""}, linear_fixed{"linear-fixed-fixed", ""};
    Block single{"single-orbits", ""}, interval{"intervals", ""}, open{"unbounded", ""}, least{"least-energies", ""};
    Block solved{"levels-solved", ""}, doubtful{"levels-solvers-differ", ""};
    Block no_contact{"no-contact-motion", ""};
    const double tick_height = 0.02 * (axes.frequency.hi - axes.frequency.lo);
    const auto tick = [&](double energy, double frequency) {
        no_contact.add(energy, frequency - 0.5 * tick_height, tick_height);
    };
    const auto is_contact = [](const Pattern& pattern) { return pattern_kind(pattern) == PatternKind::contact; };

    std::string labels;
    for (int mode = 1; mode <= most_modes; ++mode) {
        const auto points = backbone(mode, gap_sign, axes);
        for (const auto& [energy, frequency] : points) exact.add(energy, frequency);
        if (points.empty()) continue;
        exact.gap();
        const auto& [energy, frequency] = points[gap_sign == 0 ? 0 : points.size() / 3];
        labels += fmt::format("set label 'k = {}' at first {},{} {} textcolor rgb '#555555'\n", mode, energy, frequency,
                              gap_sign == 0 ? "left offset 0.8,0.8"
                                            : (gap_sign > 0 ? "right offset -1.2,0.7" : "right offset -1.0,-0.7"));
    }
    std::string ticks;
    for (int n = std::max(1, static_cast<int>(std::ceil(axes.frequency.lo))); n <= axes.frequency.hi; ++n) {
        Block& block = n % 2 == 1 ? linear_free : linear_fixed;
        block.add(axes.energy.lo, n);
        block.add(axes.energy.hi, n);
        block.gap();
        ticks += fmt::format("{}'{}ω_1' {}", ticks.empty() ? "" : ", ", n == 1 ? "" : std::to_string(n), n);
    }
    for (const PatternRecord& record : sweep.patterns) {
        if (record.verdict != Verdict::admissible || !record.interval.least) continue;
        const double frequency = record.pattern.frequency_ratio();
        const double lo = *record.interval.least;
        if (!is_contact(record.pattern)) {
            if (lo > 0.0) tick(lo, frequency);
            continue;
        }
        const double from = std::max(lo, axes.energy.lo);
        if (record.interval.unbounded) {
            open.add(from, frequency, axes.energy.hi - from);
        } else if (record.interval.greatest && *record.interval.greatest > lo * (1.0 + 1e-9)) {
            interval.add(from, frequency, std::min(*record.interval.greatest, axes.energy.hi) - from);
        } else {
            if (lo > 0.0) single.add(lo, frequency);
            continue;
        }
        if (lo >= axes.energy.lo) least.add(lo, frequency);
    }
    for (const StoredLevel& level : sweep.levels) {
        if (level.verdict != Verdict::admissible || !level.level || !level.energy) continue;
        const bool differ =
            level.agreement == name(Agreement::different_optimum) || level.agreement == name(Agreement::one_failed);
        if (!is_contact(level.pattern)) {
            tick(*level.energy, level.pattern.frequency_ratio());
        } else {
            (differ ? doubtful : solved).add(*level.energy, level.pattern.frequency_ratio());
        }
    }

    Chart chart{"frequency-energy", "", ""};
    chart.data = fmt::format("# {}: energy {}, frequency omega/omega_1, for intervals also their length\n",
                             sweep.scene.title, gap_sign == 0 ? "[J]" : "E/E_g, E_g = Y S gap^2 / (2 length)");
    const bool few_decades = axes.energy.hi < 1e5 && axes.energy.lo > 1e-4;
    chart.commands += fmt::format(
        "set title {} noenhanced\n"
        "set xlabel '{}'\nset ylabel 'frequency ω/ω_1'\n"
        "set logscale x\nset format x '{}'\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
        "set xtics out nomirror\nset ytics out nomirror\nset mxtics 10\n"
        "set border 11 linecolor rgb '#333333'\n"
        "set lmargin screen 0.12\nset rmargin screen 0.93\nset tmargin screen 0.92\n"
        "set bmargin screen 0.27\nset key at screen 0.525, screen 0.14 center top vertical "
        "maxrows 3 "
        "Left reverse samplen 3 width 1\n{}",
        gnuplot_text(sweep.scene.title), gap_sign == 0 ? "energy E (J)" : "energy E/E_g,  E_g = Y S d^2 / (2L)",
        few_decades ? "%g" : "10^{%L}", axes.energy.lo, axes.energy.hi, axes.frequency.lo, axes.frequency.hi, labels);
    if (!ticks.empty()) {
        chart.commands += fmt::format(
            "set y2range [{}:{}]\nset y2tics out "
            "({})\n",
            axes.frequency.lo, axes.frequency.hi, ticks);
    }
    bool first = true;
    const auto plot = [&](const Block& block, const char* using_columns, const char* style, const char* title) {
        if (block.rows.empty()) return;
        chart.data += fmt::format("\n\n# {}\n{}", block.name, block.rows);
        chart.commands += fmt::format("{} 'frequency-energy.dat' index '{}' using {} with {} title '{}'",
                                      first ? "plot" : ", \\\n    ", block.name, using_columns, style, title);
        first = false;
    };
    plot(linear_free, "1:2", "lines lw 1 dt 2 lc rgb '#888888'", "linear, free end");
    plot(linear_fixed, "1:2", "lines lw 1 dt 3 lc rgb '#888888'", "linear, end held");
    plot(exact, "1:2", "lines lw 5 lc rgb '#c8c8c8'", "exact mode k");
    plot(no_contact, "1:2:(0):3", "vectors nohead lw 1 lc rgb '#999999'", "no contact motion");
    plot(interval, "1:2:3:(0)", "vectors nohead lw 2 lc rgb '#0072b2'", "energy interval");
    plot(open, "1:2:3:(0)", "vectors head filled size screen 0.012,18 lw 2 lc rgb '#0072b2'", "unbounded interval");
    plot(least, "1:2", "points pt 13 ps 0.8*mark lc rgb '#0072b2'", "least energy");
    plot(single, "1:2", "points pt 7 ps 0.7*mark lc rgb '#000000'", "single orbit");
    plot(solved, "1:2", "points pt 6 ps 1.1*mark lw 2 lc rgb '#d55e00'", "level solved");
    plot(doubtful, "1:2", "points pt 2 ps 1.1*mark lw 2 lc rgb '#d55e00'", "solvers differ");
    if (first) chart.commands += "plot NaN notitle";
    chart.commands += "\n";
    return chart;
}

}  // namespace nsma
