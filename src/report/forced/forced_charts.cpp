#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "forced_folder.hpp"
#include "wave/driven_bar.hpp"
#include "nsma/orbit/backbone.hpp"
#include "report/bar_text.hpp"
#include "report/field_chart.hpp"
#include "report/one_line.hpp"

namespace nsma {
namespace {

bool has_contact(const ForcedPoint& point) { return point.peak_force > 0; }

// Factors from omega_1 and the energy unit to what axes show: hertz and joules, but of a bar without units.
struct Shown {
    double frequency = 1, energy = 1;
    std::string frequency_label = "frequency of the force ω/ω_1", energy_label = "greatest energy E/E_g";
};
Shown shown(const Scene& scene, double most_energy) {
    const Bar& bar = scene.bar;
    Shown axes;
    if (!is_unit_bar(bar)) {
        const double hertz = 0.25 / bar.travel_time();
        const ScaledUnit unit = scaled_unit(hertz * scene.forcing->frequencies.back(), "Hz");
        axes.frequency = hertz * unit.factor;
        axes.frequency_label = fmt::format("frequency of the force ({})", unit.unit);
    }
    if (!is_unit_bar(bar) || bar.gap == 0) {
        const ScaledUnit unit = scaled_unit(bar.energy_unit() * most_energy, "J");
        axes.energy = bar.energy_unit() * unit.factor;
        axes.energy_label = fmt::format("greatest energy ({})", unit.unit);
    }
    return axes;
}

// The frequencies of the scene, of one alone a hundredth to either side.
std::array<double, 2> frequency_axis(const Scene& scene) {
    const auto& frequencies = scene.forcing->frequencies;
    const double lo = frequencies.front(), hi = frequencies.back();
    return lo < hi ? std::array{lo, hi} : std::array{0.99 * lo, 1.01 * hi};
}

// Energy over frequency of the exact mode k between two frequencies.
std::string mode_rows(int mode, int gap_sign, std::array<double, 2> ends, double most, const Shown& axes) {
    std::string rows;
    const PeriodInterval periods = backbone_period_interval(mode, gap_sign);
    constexpr int pieces = 400;
    for (int i = 0; i <= pieces; ++i) {
        const double frequency = ends[0] + (ends[1] - ends[0]) * i / pieces;
        const double period = 4 / frequency;
        if (period <= periods.lo || period > periods.hi) continue;
        const double energy = backbone_energy_ratio(mode, period);
        if (energy <= most) rows += fmt::format("{} {}\n", frequency * axes.frequency, energy * axes.energy);
    }
    return rows;
}

Chart response_chart(const Scene& scene, const std::vector<ForcedPoint>& points) {
    const bool closed = scene.bar.gap == 0;
    double least = INFINITY, most = 0;
    for (const ForcedPoint& point : points) {
        least = std::min(least, point.energy_max);
        most = std::max(most, point.energy_max);
    }
    const auto [lo, hi] = frequency_axis(scene);
    const Shown axes = shown(scene, most);
    Chart chart{.name = "response",
                .data = fmt::format("# {}: {}, {}\n", scene.title, axes.frequency_label, axes.energy_label),
                .title = scene.title};
    Panel panel{.frame = Frame{0.14, 0.965, 0.31, 0.92},
                .x = {axes.frequency_label, range(lo * axes.frequency, hi * axes.frequency)},
                .y = {axes.energy_label,
                      range((most > 0 ? least / 2 : 0.1) * axes.energy, (most > 0 ? most * 4 : 1) * axes.energy)},
                .key = "at screen 0.54, screen 0.175 center top vertical maxrows 4 samplen 3 width 1 font ',12'",
                .settings = "set logscale y\n"};
    for (int mode = 1; !closed && mode <= 30; ++mode) {
        const std::string rows = mode_rows(mode, scene.bar.gap_sign(), {lo, hi}, most * 4, axes);
        if (rows.empty()) continue;
        panel.curves.push_back({chart.add(fmt::format("mode-{}", mode), rows) + " using 1:2",
                                "lines lw 5 lc rgb '#c8c8c8'",
                                fmt::format("exact mode {}, no force, no damping", mode)});
    }
    const struct {
        bool up, contact;
        const char *name, *style, *title;
    } looks[]{{true, true, "up", "linespoints lw 1.5 pt 9 ps 0.9*mark lc rgb '#0072b2'", "up, with contact"},
              {false, true, "down", "linespoints lw 1.5 pt 10 ps 1.1*mark lc rgb '#d55e00'", "down, with contact"},
              {true, false, "up-free", "points pt 7 ps 0.4*mark lc rgb '#0072b2'", "up, contact-free"},
              {false, false, "down-free", "points pt 6 ps 0.7*mark lc rgb '#d55e00'", "down, contact-free"}};
    for (const auto& look : looks) {
        std::string rows;
        for (const ForcedPoint& point : points) {
            if (point.up != look.up) continue;
            if (has_contact(point) == look.contact)
                rows += fmt::format("{} {}\n", point.frequency * axes.frequency, point.energy_max * axes.energy);
            else if (look.contact && !rows.empty() && !rows.ends_with("\n\n"))
                rows += "\n";  // the line ends
        }
        if (rows.find_first_not_of('\n') == std::string::npos) continue;
        // An empty line within a block parts lines.
        panel.curves.push_back({chart.add(look.name, rows) + " using 1:2", look.style, look.title});
    }
    std::string odd;
    for (const ForcedPoint& point : points) {
        if (point.kind == ForcedKind::chaotic || point.kind == ForcedKind::quasi_periodic ||
            point.kind == ForcedKind::transient)
            odd += fmt::format("{} {}\n", point.frequency * axes.frequency, point.energy_max * axes.energy);
    }
    if (!odd.empty())
        panel.curves.push_back({chart.add("not-periodic", odd) + " using 1:2",
                                "points pt 4 ps 1.6*mark lc rgb '#000000'", "not periodic"});
    for (const BalancePoint& jump : predicted_jumps(balance_points(scene))) {
        panel.settings +=
            fmt::format("set arrow from first {0}, graph 0 to first {0}, graph 1 nohead dt 2 lw 1.5 lc rgb '#333333'\n",
                        jump.frequency * axes.frequency);
        panel.curves.push_back(
            {"NaN", "lines dt 2 lw 1.5 lc rgb '#333333'", fmt::format("mode {} ends by energy balance", jump.mode)});
    }
    chart.panels = {std::move(panel)};
    return chart;
}

// Three points worth looking at: the most energetic with contact, the first with contact sweeping up, and the one that
// returns least.
std::vector<const ForcedPoint*> chosen(const std::vector<ForcedPoint>& points) {
    std::vector<const ForcedPoint*> found;
    const auto add = [&found](const ForcedPoint* point) {
        if (point != nullptr && std::find(found.begin(), found.end(), point) == found.end()) found.push_back(point);
    };
    const ForcedPoint *first = nullptr, *most = nullptr, *wildest = nullptr;
    for (const ForcedPoint& point : points) {
        if (!has_contact(point)) continue;
        if (first == nullptr) first = &point;
        if (most == nullptr || point.energy_max > most->energy_max) most = &point;
        if (wildest == nullptr || point.defect > wildest->defect) wildest = &point;
    }
    add(first);
    add(most);
    add(wildest);
    return found;
}

// The bar at the end of a point, and the force on it in the steps that follow.
DrivenBar bar_at(const Scene& scene, const ForcedPoint& point) {
    return {scene.bar, scene.mesh, state_of_waves(scene.bar, point.waves), scene.damping};
}
double force_at(const Scene& scene, const ForcedPoint& point, int step) {
    const double period = 4.0 * scene.mesh.cells / point.frequency;
    return scene.forcing->amplitude * std::cos(2 * std::numbers::pi * (point.phase + (step + 0.5) / period));
}

std::string point_text(const ForcedPoint& point) {
    return fmt::format("ω/ω₁ = {:.4g}, sweeping {}: {}", point.frequency, point.up ? "up" : "down", name(point.kind));
}

// Over one period of the force from the beginning of a flight or, where it never leaves the wall or touches it, from
// now.
Chart fields_chart(const Scene& scene, const ForcedPoint& point) {
    constexpr int most_samples = 400;
    const double period = 4.0 * scene.mesh.cells / point.frequency;
    const auto steps = static_cast<int>(std::ceil(period));
    DrivenBar driven = bar_at(scene, point);
    int begin = 0;
    for (bool before = false; begin < steps; ++begin) {
        DrivenBar ahead = driven;
        const bool presses = ahead.step(force_at(scene, point, begin)).wall_force < 0;
        if (before && !presses) break;
        before = presses;
        driven = std::move(ahead);
    }
    const int every_step = (steps + most_samples - 1) / most_samples;
    const int every_cell = (scene.mesh.cells + most_samples - 1) / most_samples;
    const double time_step = scene.mesh.time_step(scene.bar);
    const int rows = (steps + every_step - 1) / every_step;
    const int columns = (scene.mesh.cells + every_cell - 1) / every_cell;
    FieldSamples fields{
        Eigen::MatrixXd(rows, columns), Eigen::MatrixXd(rows, columns), rows * every_step * time_step, {}};
    bool contact = false;
    for (int n = 0; n < steps; ++n) {
        if (n % every_step == 0) {
            const State now = driven.queue().state();
            for (int column = 0; column < columns; ++column) {
                const Eigen::Index cell = Eigen::Index{column} * every_cell;
                fields.stress(n / every_step, column) = now[cell];
                fields.velocity(n / every_step, column) = now[scene.mesh.cells + cell];
            }
        }
        const bool presses = driven.step(force_at(scene, point, begin + n)).wall_force < 0;
        if (presses && !contact) fields.contacts.push_back({n * time_step, n * time_step});
        if (presses) fields.contacts.back()[1] = (n + 1) * time_step;
        contact = presses;
    }
    return field_chart(scene.bar, fields, "forced-fields", scene.title,
                       fmt::format("{}: {}", shortened(scene.title, 60), point_text(point)));
}

// The force that holds a mode against the damping, over its frequency: where it is the force itself, the response ends.
Chart balance_chart(const Scene& scene, const std::vector<BalancePoint>& points) {
    const auto [lo, hi] = frequency_axis(scene);
    const double force = scene.forcing->amplitude;
    const Shown axes = shown(scene, 1.0);
    const ScaledUnit unit = scaled_unit(force, "N");
    double least = force * unit.factor, most = least;
    for (const BalancePoint& point : points) {
        least = std::min(least, force / point.ratio * unit.factor);
        most = std::max(most, force / point.ratio * unit.factor);
    }
    Chart chart{.name = "balance",
                .data = fmt::format("# {}: frequency omega/omega_1, force [{}]\n", scene.title, unit.unit),
                .title = scene.title};
    Panel panel{.frame = Frame{0.14, 0.965, 0.27, 0.92},
                .x = {axes.frequency_label, range(lo * axes.frequency, hi * axes.frequency)},
                .y = {fmt::format("force that holds the mode ({})", unit.unit), range(0.8 * least, 1.25 * most)},
                .key = "at screen 0.54, screen 0.13 center top vertical maxrows 2 samplen 3 width 1 font ',12'",
                .settings = "set logscale y\n"};
    std::size_t place = 0;
    for (const int mode : distinct(points, [](const BalancePoint& point) { return point.mode; })) {
        std::string rows;
        for (const BalancePoint& point : points) {
            if (point.mode == mode)
                rows += fmt::format("{} {}\n", point.frequency * axes.frequency, force / point.ratio * unit.factor);
        }
        panel.curves.push_back({chart.add(fmt::format("mode-{}", mode), rows) + " using 1:2",
                                marked_line(curve_styles.at(place++ % curve_styles.size()), 0.6),
                                fmt::format("mode {}", mode)});
    }
    panel.curves.push_back(
        {fmt::format("{}", force * unit.factor), "lines dt 2 lw 1.5 lc rgb '#333333'", "force of the scene"});
    chart.panels = {std::move(panel)};
    return chart;
}

Chart motions_chart(const Scene& scene, const std::vector<const ForcedPoint*>& points) {
    Chart chart{.name = "forced-motions",
                .data = fmt::format("# {}: tip over two periods of the force, and once a period\n", scene.title),
                .title = scene.title,
                .height = 260 * static_cast<int>(points.size()) + 60};
    const Bar& bar = scene.bar;
    const double rows_height = 0.84 / static_cast<double>(points.size());
    double largest = std::abs(bar.gap);
    for (const ForcedPoint* point : points)
        largest = std::max({largest, std::abs(point->tip_least), std::abs(point->tip_greatest)});
    const ScaledUnit length = is_unit_bar(bar) ? ScaledUnit{1.0, "d"} : scaled_unit(largest, "m");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ForcedPoint& point = *points[i];
        const double period = 4.0 * scene.mesh.cells / point.frequency;
        DrivenBar driven = bar_at(scene, point);
        std::string motion, section;
        for (int n = 0; n <= 2 * period; ++n) {
            motion += fmt::format("{} {}\n", n / period, driven.tip() * length.factor);
            (void)driven.step(force_at(scene, point, n));
        }
        double speed = 0;
        for (const auto& one : point.section) speed = std::max(speed, std::abs(one[1]));
        const ScaledUnit velocity = scaled_unit(speed, "m/s");
        for (const auto& [tip, tip_velocity] : point.section)
            section += fmt::format("{} {}\n", tip * length.factor, tip_velocity * velocity.factor);
        const double top = 0.92 - rows_height * static_cast<double>(i);
        const std::string title =
            fmt::format("ω/ω_1 = {:.4g}, sweeping {}: {}", point.frequency, point.up ? "up" : "down", name(point.kind));
        double slowest = INFINITY, fastest = -INFINITY, low = INFINITY, high = -INFINITY;
        for (const auto& [tip, tip_velocity] : point.section) {
            low = std::min(low, tip * length.factor);
            high = std::max(high, tip * length.factor);
            slowest = std::min(slowest, tip_velocity * velocity.factor);
            fastest = std::max(fastest, tip_velocity * velocity.factor);
        }
        // At least a hundredth of the range: what differs less is a point.
        const auto axis = [](double from, double to, double least) {
            const double half = std::max({0.6 * (to - from), 0.5 * least, 1e-3 * std::abs(from + to), 1e-9});
            return std::array{0.5 * (from + to) - half, 0.5 * (from + to) + half};
        };
        const auto across = axis(low, high, 0.01 * (point.tip_greatest - point.tip_least) * length.factor);
        const auto along = axis(slowest, fastest, 0.01 * speed * velocity.factor);
        const auto ticks = [](const std::array<double, 2>& ends) {
            return fmt::format("{}", round_below((ends[1] - ends[0]) / 2));
        };
        const double margin = 0.08 * std::max((point.tip_greatest - point.tip_least) * length.factor, 1e-9);
        chart.panels.push_back(
            {.frame = Frame{0.11, 0.56, top - rows_height + 0.11, top - 0.03},
             .title = title,
             .x = {i + 1 == points.size() ? "time, in periods of the force" : "", range(0.0, 2.0)},
             .y = {fmt::format("tip x ({})", length.unit),
                   range(point.tip_least * length.factor - margin,
                         std::max(point.tip_greatest, bar.gap) * length.factor + margin)},
             .curves = {
                 {fmt::format("{}", bar.gap * length.factor), "lines dt 2 lw 1.5 lc rgb '#333333'"},
                 {chart.add(fmt::format("motion-{}", i + 1), motion) + " using 1:2", "lines lw 2 lc rgb '#0072b2'"}}});
        chart.panels.push_back(
            {.frame = Frame{0.70, 0.97, top - rows_height + 0.11, top - 0.03},
             .title = "once a period",
             .x = {i + 1 == points.size() ? fmt::format("tip x ({})", length.unit) : "", range(across[0], across[1]),
                   ticks(across)},
             .y = {fmt::format("velocity ({})", velocity.unit), range(along[0], along[1]), ticks(along)},
             .curves = {{chart.add(fmt::format("section-{}", i + 1), section) + " using 1:2",
                         "points pt 7 ps 0.5*mark lc rgb '#d55e00'"}}});
    }
    return chart;
}

}  // namespace

std::vector<Chart> forced_charts(const Scene& scene, const std::vector<ForcedPoint>& points) {
    std::vector<Chart> charts;
    if (points.empty()) return charts;
    charts.push_back(response_chart(scene, points));
    const auto balance = balance_points(scene);
    if (!balance.empty() && scene.damping.kind != Damping::Kind::none) charts.push_back(balance_chart(scene, balance));
    if (const auto some = chosen(points); !some.empty()) {
        charts.push_back(motions_chart(scene, some));
        charts.push_back(fields_chart(scene, *some.at(some.size() > 1 ? 1 : 0)));
    }
    return charts;
}

}  // namespace nsma
