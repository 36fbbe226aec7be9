#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "orbit_panels.hpp"
#include "nsma/orbit/backbone.hpp"
#include "report/bar_text.hpp"

namespace nsma {
namespace {

constexpr int most_modes = 30;

/// Of energies or frequencies, which are > 0; others are left out.
struct Range {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -lo;

    void add(double value) {
        if (!std::isfinite(value) || value <= 0.0) return;
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    [[nodiscard]] bool empty() const { return lo > hi; }
};

/// What the axes must show.
struct Axes {
    Range energy;
    Range frequency;
};

/// The axes hold every single orbit, every start of an interval and every level; of the ends of
/// intervals only those within a decade of the rest, lest one long interval squeeze the others.
Axes axes_of(const StoredSweep& sweep) {
    Axes axes;
    Range ends;
    for (const PatternRecord& record : sweep.patterns) {
        if (record.verdict != Verdict::admissible) continue;
        axes.frequency.add(record.pattern.frequency_ratio());
        axes.energy.add(record.interval.least.value_or(0.0));
        ends.add(record.interval.greatest.value_or(0.0));
    }
    for (const StoredLevel& level : sweep.levels) {
        if (level.verdict == Verdict::admissible) axes.energy.add(level.energy.value_or(0.0));
    }
    for (const double level : sweep.scene.levels) axes.energy.add(level);
    axes.energy.add(std::min(ends.hi, 10.0 * axes.energy.hi));
    if (axes.energy.empty()) axes.energy.add(1.0);
    if (axes.frequency.empty()) {
        axes.frequency.add(sweep.patterns.empty() ? 1.0 : sweep.patterns.front().pattern.frequency_ratio());
    }

    axes.energy.lo /= 1.5;
    axes.energy.hi *= 1.5;
    const double spread = axes.frequency.hi - axes.frequency.lo;
    // The linear frequency that a branch starts from belongs in the picture when it is near.
    for (const double nearest : {std::floor(axes.frequency.lo), std::ceil(axes.frequency.hi)}) {
        const double distance = std::max(axes.frequency.lo - nearest, nearest - axes.frequency.hi);
        if (distance < 0.35 * spread) axes.frequency.add(nearest);
    }
    const double margin = spread > 0.0 ? std::max(0.04, 0.06 * spread) : 0.4;
    axes.frequency.lo = std::max(0.0, axes.frequency.lo - margin);
    axes.frequency.hi += std::max(margin, 0.12 * spread);  // room for a branch that begins there
    return axes;
}

/// Energy and frequency along the exact mode k, within the axes' energies; empty out of range.
std::vector<std::pair<double, double>> backbone(int mode, int gap_sign, const Axes& axes) {
    const PeriodInterval periods = backbone_period_interval(mode, gap_sign);
    const bool closed = gap_sign == 0;  // then one period at every energy
    const double least = closed ? axes.energy.lo : backbone_energy_ratio(mode, gap_sign > 0 ? periods.hi : periods.lo);
    const double limit = (2.0 * mode + 1.0) / (1.0 * mode * mode);  // T/tau as E -> infinity
    const int pieces = closed ? 1 : 400;
    std::vector<std::pair<double, double>> points;
    for (int i = 0; i <= pieces && least < axes.energy.hi; ++i) {
        const double energy = least * std::pow(axes.energy.hi / least, static_cast<double>(i) / pieces);
        const double frequency = 4.0 / (limit + gap_sign / (std::sqrt(energy) * mode * mode));
        if (energy >= axes.energy.lo && frequency >= axes.frequency.lo && frequency <= axes.frequency.hi) {
            points.emplace_back(energy, frequency);
        }
    }
    return points;
}

std::string point(double energy, double frequency) { return fmt::format("{} {}\n", energy, frequency); }
std::string segment(double energy, double frequency, double length) {
    return fmt::format("{} {} {}\n", energy, frequency, length);
}

/// Energy E/E_g at which the tip of the linear mode with a free end and frequency n omega_1, n odd, reaches the wall:
/// x = d sin(n pi s/2L) stores (n pi)^2/8 E_g.
double grazing_energy(int n) { return std::pow(n * std::numbers::pi, 2) / 8.0; }

/// The chart, drawn from the bottom to the top.
struct Diagram {
    Axes axes;
    Chart& chart;
    Panel panel;

    void draw(const char* block, const std::string& rows, const char* columns, const char* style, const char* title) {
        if (!rows.empty()) panel.curves.push_back({chart.add(block, rows) + " using " + columns, style, title});
    }
};

bool is_contact(const Pattern& pattern) { return pattern_kind(pattern) == PatternKind::contact; }

// Linear vibrations, those with a free end up to the energy at which their tip reaches an open gap.
void draw_linear_modes(Diagram& diagram, int gap_sign) {
    const auto& [energy, frequency] = diagram.axes;
    std::string odd, even, grazing;
    for (int n = std::max(1, static_cast<int>(std::ceil(frequency.lo))); n <= frequency.hi; ++n) {
        const bool free = n % 2 == 1;
        const double end = free && gap_sign > 0 ? grazing_energy(n) : energy.hi;
        if (end > energy.lo) (free ? odd : even) += point(energy.lo, n) + point(std::min(end, energy.hi), n) + "\n";
        if (free && gap_sign > 0 && end > energy.lo && end < energy.hi) grazing += point(end, n);
        const bool ends = end < energy.hi;  // its name stands behind it, else above its end
        diagram.panel.settings += fmt::format("set label '{}ω_1' at first {}, first {} {} textcolor rgb '#888888'\n",
                                              n == 1 ? "" : std::to_string(n), ends ? end : energy.hi, n,
                                              ends ? "left offset 1.2,0" : "right offset -0.5,0.6");
    }
    diagram.draw("linear-free-fixed", odd, "1:2", "lines lw 1 dt 2 lc rgb '#888888'", "linear, free end");
    diagram.draw("grazing", grazing, "1:2", "points pt 3 ps 1.2*mark lw 1.5 lc rgb '#555555'",
                 "its tip grazes the wall");
    diagram.draw("linear-fixed-fixed", even, "1:2", "lines lw 1 dt 3 lc rgb '#888888'", "linear, end held");
}

// Of a bar with units a second pair of axes, in joules and hertz.
void add_physical_axes(Diagram& diagram, const Bar& bar) {
    if (is_unit_bar(bar)) return;
    const double linear = 0.25 / bar.travel_time();  // f_1 [Hz]
    const ScaledUnit hertz = scaled_unit(linear * diagram.axes.frequency.hi, "Hz");
    const double hertz_each = linear * hertz.factor;
    diagram.panel.settings +=
        fmt::format("set y2range [{}]\nset y2tics out\nset y2label 'frequency ({})' offset -0.5,0\n",
                    range(diagram.axes.frequency.lo * hertz_each, diagram.axes.frequency.hi * hertz_each), hertz.unit);
    diagram.panel.frame->right -= 0.075;
    if (bar.gap == 0) return;
    const double joules = bar.energy_unit();
    const ScaledUnit unit = scaled_unit(joules * diagram.axes.energy.hi, "J");
    const double joules_each = joules * unit.factor;
    diagram.panel.settings += fmt::format(
        "set logscale x2\nset x2range [{}]\nset x2tics out format '%g'\nset x2label 'energy E ({})' offset 0,-0.5\n",
        range(diagram.axes.energy.lo * joules_each, diagram.axes.energy.hi * joules_each), unit.unit);
    diagram.panel.frame->top -= 0.09;
    diagram.panel.settings += "set border 15\nset title offset 0,0.3\n";
}

void draw_modes(Diagram& diagram, int gap_sign) {
    const char* place = gap_sign == 0  ? "left offset 0.8,-0.9"
                        : gap_sign > 0 ? "right offset -1.2,0.7"
                                       : "right offset -1.0,-0.7";
    std::string rows, limits;
    const auto& [shown, frequencies] = diagram.axes;
    for (int mode = 1; mode <= most_modes; ++mode) {
        const auto points = backbone(mode, gap_sign, diagram.axes);
        if (points.empty()) continue;
        const double limit = 4.0 * mode * mode / (2.0 * mode + 1.0);
        if (gap_sign != 0 && limit > frequencies.lo && limit < frequencies.hi)
            limits += point(shown.lo, limit) + point(shown.hi, limit) + "\n";
        for (const auto& [energy, frequency] : points) rows += point(energy, frequency);
        rows += "\n";
        const auto& [energy, frequency] = points[gap_sign == 0 ? 0 : points.size() / 3];
        diagram.panel.settings += fmt::format("set label 'k = {}' at first {},{} {} textcolor rgb '#555555'\n", mode,
                                              energy, frequency, place);
    }
    diagram.draw("limits", limits, "1:2", "lines lw 1 dt 4 lc rgb '#aaaaaa'", "exact mode, E → ∞");
    diagram.draw("exact-modes", rows, "1:2", "lines lw 5 lc rgb '#c8c8c8'", "exact mode k");
}

void draw_records(Diagram& diagram, const StoredSweep& sweep) {
    const auto& [shown, frequencies] = diagram.axes;
    const double tick = 0.02 * (frequencies.hi - frequencies.lo);
    std::string no_contact, interval, unbounded, least_energy, single, solved, unproved, doubtful, absent;
    for (const PatternRecord& record : sweep.patterns) {
        if (record.verdict != Verdict::admissible || !record.interval.least) continue;
        const double frequency = record.pattern.frequency_ratio();
        const double least = *record.interval.least;
        const double greatest = record.interval.unbounded ? shown.hi : record.interval.greatest.value_or(least);
        const double from = std::max(least, shown.lo);
        if (!is_contact(record.pattern)) {
            if (least > 0.0) no_contact += segment(least, frequency - 0.5 * tick, tick);
        } else if (!record.interval.unbounded && greatest <= least * (1.0 + 1e-9)) {
            if (least > 0.0) single += point(least, frequency);
        } else {
            (record.interval.unbounded ? unbounded : interval) +=
                segment(from, frequency, std::min(greatest, shown.hi) - from);
            if (least >= shown.lo) least_energy += point(least, frequency);
        }
    }
    for (const StoredLevel& level : sweep.levels) {
        const double frequency = level.pattern.frequency_ratio();
        const bool none = level.verdict == Verdict::below || level.verdict == Verdict::above;
        if (none && level.level && is_contact(level.pattern)) absent += point(*level.level, frequency);
        if (level.verdict != Verdict::admissible || !level.level || !level.energy) continue;
        const bool differ =
            level.agreement == name(Agreement::different_optimum) || level.agreement == name(Agreement::one_failed);
        if (is_contact(level.pattern)) {
            (differ ? doubtful : level.proved ? solved : unproved) += point(*level.energy, frequency);
        } else {
            no_contact += segment(*level.energy, frequency - 0.5 * tick, tick);
        }
    }
    diagram.draw("levels-without-orbit", absent, "1:2", "points pt 7 ps 0.3*mark lc rgb '#aaaaaa'", "level, no orbit");
    diagram.draw("no-contact-motion", no_contact, "1:2:(0):3", "vectors nohead lw 1 lc rgb '#999999'",
                 "no contact motion");
    diagram.draw("intervals", interval, "1:2:3:(0)", "vectors nohead lw 2 lc rgb '#0072b2'", "energy interval");
    diagram.draw("unbounded", unbounded, "1:2:3:(0)", "vectors head filled size screen 0.012,18 lw 2 lc rgb '#0072b2'",
                 "unbounded interval");
    diagram.draw("least-energies", least_energy, "1:2", "points pt 13 ps 0.8*mark lc rgb '#0072b2'", "least energy");
    diagram.draw("single-orbits", single, "1:2", "points pt 7 ps 0.7*mark lc rgb '#000000'", "single orbit");
    diagram.draw("levels-solved", solved, "1:2", "points pt 6 ps 1.1*mark lw 2 lc rgb '#d55e00'", "level solved");
    diagram.draw("levels-unproved", unproved, "1:2", "points pt 4 ps 1.1*mark lw 2 lc rgb '#d55e00'",
                 "solved, not proved best");
    diagram.draw("levels-solvers-differ", doubtful, "1:2", "points pt 2 ps 1.1*mark lw 2 lc rgb '#d55e00'",
                 "solvers differ");
}

void draw_choice(Diagram& diagram, const OrbitChoice& choice) {
    std::string marks;
    diagram.panel.settings += "set style textbox opaque noborder fillcolor rgb '#ffffff' margins 0.3,0.3\n";
    for (std::size_t i = 0; i < choice.orbits.size(); ++i) {
        const StoredOrbit& stored = *choice.orbits[i];
        const double frequency = stored.orbit.kernel.pattern.frequency_ratio();
        marks += point(stored.energy, frequency);
        diagram.panel.settings +=
            fmt::format("set label '{}' at first {},{} right offset -0.9,0.7 front font ',15' boxed\n", roman(i),
                        stored.energy, frequency);
    }
    diagram.draw("orbits-drawn", marks, "1:2", "points pt 6 ps 2*mark lw 2 lc rgb '#000000'", "orbit shown");
}

// The whole diagram in a frame, its blocks added to the chart; the legend has `columns` and its top at `key`.
Panel diagram_panel(Chart& chart, const StoredSweep& sweep, const OrbitChoice& choice, const Frame& frame,
                    std::array<double, 2> key, int columns) {
    const Axes axes = axes_of(sweep);
    const int gap_sign = sweep.scene.bar.gap_sign();
    const bool few_decades = axes.energy.hi < 1e5 && axes.energy.lo > 1e-4;
    Diagram diagram{axes,
                    chart,
                    {.frame = frame,
                     .x = {gap_sign == 0 ? "energy E (J)" : "energy E/E_g,  E_g = Y S d^2 / (2L)",
                           range(axes.energy.lo, axes.energy.hi)},
                     .y = {"frequency ω/ω_1", range(axes.frequency.lo, axes.frequency.hi)},
                     .settings = fmt::format("set logscale x\nset format x '{}'\nset mxtics 10\nset border 11\n",
                                             few_decades ? "%g" : "10^{%L}")}};
    draw_linear_modes(diagram, gap_sign);
    draw_modes(diagram, gap_sign);
    draw_records(diagram, sweep);
    draw_choice(diagram, choice);
    add_physical_axes(diagram, sweep.scene.bar);
    const auto entries = std::count_if(diagram.panel.curves.begin(), diagram.panel.curves.end(),
                                       [](const Curve& curve) { return !curve.title.empty(); });
    diagram.panel.key =
        fmt::format("at screen {}, screen {} center top vertical maxrows {} samplen 3 width 1 font ',12'", key[0],
                    key[1], std::max<std::ptrdiff_t>(3, (entries + columns - 1) / columns));
    return diagram.panel;
}

std::string data_head(const Scene& scene) {
    return fmt::format("# {}: energy {}, frequency omega/omega_1, for intervals also their length\n", scene.title,
                       scene.bar.gap_sign() == 0 ? "[J]" : "E/E_g, E_g = Y S gap^2 / (2 length)");
}

}  // namespace

Chart frequency_energy_chart(const StoredSweep& sweep, const OrbitChoice& choice) {
    Chart chart{.name = "frequency-energy", .data = data_head(sweep.scene)};
    // Three columns at most: a fourth would leave the picture.
    Panel panel = diagram_panel(chart, sweep, choice, {0.12, 0.93, 0.28, 0.92}, {0.525, 0.15}, 3);
    panel.title = sweep.scene.title;
    chart.panels = {std::move(panel)};
    return chart;
}

Chart overview_chart(const StoredSweep& sweep, const OrbitChoice& choice) {
    Chart chart{
        .name = "overview",
        .data = fmt::format("# Tip displacement: time, value, value where a marker stands\n{}", data_head(sweep.scene)),
        .title = sweep.scene.title,
        .height = 520};
    Panel tips = tip_panel(chart, sweep.scene, choice, {0.11, 0.465, 0.37, 0.88});
    Panel diagram = diagram_panel(chart, sweep, choice, {0.585, 0.975, 0.37, 0.88}, {0.78, 0.215}, 2);
    chart.panels = {std::move(tips), std::move(diagram)};
    return chart;
}

}  // namespace nsma
