#include <algorithm>

#include <fmt/format.h>

#include "sensitivity_charts.hpp"
#include "report/bar_text.hpp"
#include "report/orbit_units.hpp"

namespace nsma {
namespace {

// What relaxing one row saves, relative, also where only an orbit tied with this one uses it; zero where there is no
// number.
double saving(const OptimumRecord& optimum, const Price& price) {
    return price.slope.right ? std::max(-*price.slope.right / optimum.value, 0.0) : 0.0;
}

bool is_row(const Price& price) {
    return price.parameter == Parameter::cond1_row || price.parameter == Parameter::cond3_row;
}

constexpr double least_saving = 1e-9;  // what is not above it is rounding

double highest_saving(const OptimumRecord& optimum) {
    double highest = least_saving;
    for (const auto& price : optimum.prices) {
        if (is_row(price)) highest = std::max(highest, saving(optimum, price));
    }
    return highest > least_saving ? highest : 0.0;
}

/// What each row of one condition saves, at the times of its steps; `offset` in steps, which last `step_time`.
std::string saving_rows(const OptimumRecord& optimum, Parameter parameter, double offset, double step_time) {
    std::string rows;
    for (const auto& price : optimum.prices) {
        if (price.parameter != parameter || saving(optimum, price) <= least_saving) continue;
        for (const int step : price.steps)
            rows += fmt::format("{} {}\n", (step + offset) * step_time, saving(optimum, price));
    }
    return rows;
}

std::string elasticity_text(const OptimumRecord& optimum, int gap_sign) {
    std::string text;
    for (const auto& [parameter, words] :
         {std::pair{Parameter::gap, "gap"}, std::pair{Parameter::contact, "place of contact"},
          std::pair{Parameter::energy, "energy"}}) {
        const auto slope = right_slope(optimum.prices, parameter);
        if (!slope) continue;
        text += fmt::format("{}{} {:+.3g}", text.empty() ? "elasticity of the objective: " : ", ", words,
                            elasticity(*slope, parameter, optimum.value, gap_sign,
                                       optimum.level.value_or(energy_ratio(optimum.orbit))));
    }
    return text;
}

/// Panel settings that shade and name the phase of contact below the wall.
std::string contact_phase(const Pattern& pattern, double step_time, double at_wall) {
    const double from = pattern.free_steps * step_time;
    const double to = pattern.period_steps() * step_time;
    const bool narrow = 8 * pattern.contact_steps < pattern.period_steps();  // for the word
    return fmt::format(
        "set object rectangle from first {}, graph 0 to first {}, first {} behind fillcolor rgb '#f2f2f2' fillstyle "
        "solid noborder\nset label 'contact' at first {}, graph 0.06 {} textcolor rgb '#555555'\n",
        from, to, at_wall, narrow ? to : (from + to) / 2.0, narrow ? "right" : "center");
}

}  // namespace

std::optional<double> right_slope(const std::vector<Price>& prices, Parameter parameter) {
    for (const auto& price : prices) {
        if (price.parameter == parameter) return price.slope.right;
    }
    return std::nullopt;
}

std::string text_of(const Pattern& pattern) {
    return fmt::format("N = {}, r = {}, p = {}", pattern.cells, pattern.free_steps, pattern.contact_steps);
}

std::string level_text(const char* separator, const OptimumRecord& optimum) {
    const Bar& bar = optimum.orbit.bar;
    if (!optimum.level) return {};
    if (is_unit_bar(bar) && bar.gap != 0) return fmt::format("{}E = {:.3g} E_g", separator, *optimum.level);
    return fmt::format("{}E = {}", separator, si_text(*optimum.level * bar.energy_unit(), "J"));
}

int binding_rows(const OptimumRecord& optimum) {
    const double highest = highest_saving(optimum);
    int rows = 0;
    for (const auto& price : optimum.prices) {
        if (!is_row(price) || highest <= 0 || saving(optimum, price) < 0.1 * highest) continue;
        rows += price.parameter == Parameter::cond1_row ? 3 : 1;
    }
    return rows;
}

Chart binding_chart(const Scene& scene, const OptimumRecord& optimum) {
    const Pattern& pattern = optimum.orbit.kernel.pattern;
    const Eigen::VectorXd tip_in_metres = tip_displacement(optimum.orbit);
    const Units units = units_of(scene.bar, pattern.period_ratio(), tip_in_metres.cwiseAbs().maxCoeff());
    const Eigen::VectorXd tip = tip_in_metres * units.length.factor;
    const double step = optimum.orbit.mesh().time_step(scene.bar) * units.time.factor;
    const double period = pattern.period_steps() * step;
    const double at_wall = scene.bar.gap * units.length.factor;
    const double head = 0.14 * std::max(at_wall - tip.minCoeff(), 1e-9);
    const double highest = highest_saving(optimum);
    Chart chart{.name = "binding",
                .data = fmt::format("# {}: time [{}], x_1 [{}]; then step time and saving [% of the objective per % of "
                                    "|d| or of Y S |d|/L]\n",
                                    scene.title, units.time.unit, units.length.unit),
                .settings = "set ylabel offset 0.5,0\nset title enhanced\n"};
    std::string motion, active;
    for (Eigen::Index n = 0; n < tip.size(); ++n)
        motion += fmt::format("{} {}\n", static_cast<double>(n) * step, tip[n]);
    for (const auto& price : optimum.prices) {
        if (price.parameter != Parameter::cond1_row || !price.active) continue;
        for (const int n : price.steps) active += fmt::format("{} {}\n", n * step, tip[n]);
    }
    const char* active_mark = "points pt 7 ps 0.9*mark lc rgb '#d55e00'";
    Panel motions{.frame = Frame{0.12, 0.97, 0.55, 0.92},
                  .title = fmt::format("Where the wall decides: {}, {}{}", name(optimum.objective), text_of(pattern),
                                       level_text(", ", optimum)),
                  .x = {"", range(0.0, period), "format ''"},
                  .y = {units.tip_label, range(tip.minCoeff() - 0.5 * head, at_wall + head)},
                  .settings = wall(at_wall, at_wall + 0.5 * head, "wall") + contact_phase(pattern, step, at_wall),
                  .curves = {{fmt::format("{}", at_wall), "lines lw 1 lc rgb '#333333'"},
                             {chart.add("tip", motion) + " using 1:2", "lines lw 2 lc rgb '#000000'"}}};
    Panel savings{.frame = Frame{0.12, 0.97, 0.24, 0.50},
                  .x = {units.time_label, range(0.0, period), "format '%g'"},
                  .y = {"objective saved (%)", range(0.0, highest > 0 ? 1.15 * highest : 1.0),
                        fmt::format("{}", round_below((highest > 0 ? highest : 1.0) / 3.0))},
                  .key = "at screen 0.545, screen 0.11 center top vertical maxrows 3 samplen 3",
                  .settings = fmt::format("set boxwidth {}\nset label {} at graph 0.01, graph 1.08 left noenhanced "
                                          "textcolor rgb '#333333'\n",
                                          0.7 * step, gnuplot_text(elasticity_text(optimum, scene.bar.gap_sign())))};
    const auto add_savings = [&](const char* block, const std::string& rows, const char* style, const char* title) {
        if (!rows.empty()) savings.curves.push_back({chart.add(block, rows) + " using 1:2", style, title});
    };
    add_savings("wall", saving_rows(optimum, Parameter::cond1_row, 0.0, step),
                "boxes lc rgb '#d55e00' fillstyle solid 0.8 border lc rgb '#d55e00'",
                "COND1: saved per penetration of 1 % of |d| at this step");
    add_savings("push", saving_rows(optimum, Parameter::cond3_row, 0.5, step),
                "boxes lc rgb '#000000' fillstyle pattern 4 border lc rgb '#000000'",
                "COND3: saved per tension of 1 % of YS|d|/L at this step");
    if (savings.curves.empty()) {
        savings.settings += "set label 'no step has a price' at graph 0.5, graph 0.5 center textcolor rgb '#555555'\n";
    }
    if (!active.empty()) {
        motions.curves.push_back({chart.add("active", active) + " using 1:2", active_mark});
        savings.curves.push_back({"NaN", active_mark, "above: steps of the flight at the wall"});
    }
    chart.panels = {std::move(motions), std::move(savings)};
    return chart;
}

}  // namespace nsma
