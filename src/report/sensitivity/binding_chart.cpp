#include <algorithm>

#include <fmt/format.h>

#include "sensitivity_charts.hpp"

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

/// What each row of one condition saves, at the times of its steps; `offset` in steps.
std::string saving_rows(const OptimumRecord& optimum, Parameter parameter, double offset) {
    std::string rows;
    for (const auto& price : optimum.prices) {
        if (price.parameter != parameter || saving(optimum, price) <= least_saving) continue;
        for (const int step : price.steps) {
            rows +=
                fmt::format("{} {}\n", (step + offset) / optimum.orbit.kernel.pattern.cells, saving(optimum, price));
        }
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
std::string contact_phase(const Pattern& pattern, double at_wall) {
    const double from = static_cast<double>(pattern.free_steps) / pattern.cells;
    const double to = pattern.period_ratio();
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
    return optimum.level ? fmt::format("{}E = {:.3g} E_g", separator, *optimum.level) : "";
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
    const double cells = pattern.cells;
    const double period = pattern.period_ratio();
    const Eigen::VectorXd tip = tip_history(optimum.orbit.kernel, optimum.orbit.beta);
    const double at_wall = scene.bar.gap_sign();
    const double head = 0.14 * std::max(at_wall - tip.minCoeff(), 1e-9);
    const double highest = highest_saving(optimum);
    Chart chart{.name = "binding",
                .data = fmt::format("# {}: time t/tau, x_1/u; then step time and saving [% of the objective per % of "
                                    "|d| or of Y S |d|/L]\n",
                                    scene.title),
                .settings = "set ylabel offset 0.5,0\nset title enhanced\n"};
    std::string motion, active;
    for (Eigen::Index n = 0; n < tip.size(); ++n)
        motion += fmt::format("{} {}\n", static_cast<double>(n) / cells, tip[n]);
    for (const auto& price : optimum.prices) {
        if (price.parameter != Parameter::cond1_row || !price.active) continue;
        for (const int step : price.steps) active += fmt::format("{} {}\n", step / cells, tip[step]);
    }
    const std::string flight = saving_rows(optimum, Parameter::cond1_row, 0.0);
    const std::string contact = saving_rows(optimum, Parameter::cond3_row, 0.5);
    const char* wall_line = "lines lw 1 lc rgb '#333333'";
    const char* active_mark = "points pt 7 ps 0.9*mark lc rgb '#d55e00'";
    chart.panels = {
        {.frame = Frame{0.12, 0.97, 0.55, 0.92},
         .title = fmt::format("Where the wall decides: {}, {}{}", name(optimum.objective), text_of(pattern),
                              level_text(", ", optimum)),
         .x = {"", range(0.0, period), "format ''"},
         .y = {"x_1/|d|", range(tip.minCoeff() - 0.5 * head, at_wall + head)},
         .settings = wall(at_wall, at_wall + 0.5 * head, "wall") + contact_phase(pattern, at_wall),
         .curves = {{fmt::format("{}", at_wall), wall_line},
                    {chart.add("tip", motion) + " using 1:2", "lines lw 2 lc rgb '#000000'"},
                    {chart.add("active", active) + " using 1:2", active_mark}}},
        {.frame = Frame{0.12, 0.97, 0.24, 0.50},
         .x = {"time t/τ, τ = L/c", range(0.0, period), "format '%g'"},
         .y = {"saved [%]", range(0.0, highest > 0 ? 1.15 * highest : 1.0),
               fmt::format("{}", round_below((highest > 0 ? highest : 1.0) / 3.0))},
         .key = "at screen 0.545, screen 0.11 center top vertical maxrows 3 samplen 3",
         .settings = fmt::format("set boxwidth {}\nset label {} at graph 0.01, graph 1.08 left noenhanced textcolor "
                                 "rgb '#333333'\n",
                                 0.7 / cells, gnuplot_text(elasticity_text(optimum, scene.bar.gap_sign()))),
         .curves = {{chart.add("wall", flight) + " using 1:2",
                     "boxes lc rgb '#d55e00' fillstyle solid 0.8 border lc rgb '#d55e00'",
                     flight.empty() ? "COND1: no step of the flight has a price"
                                    : "COND1: saved per penetration of 1 % of |d| at this step"},
                    {chart.add("push", contact) + " using 1:2",
                     "boxes lc rgb '#000000' fillstyle pattern 4 border lc rgb '#000000'",
                     contact.empty() ? "COND3: no step of contact has a price"
                                     : "COND3: saved per tension of 1 % of YS|d|/L at this step"},
                    {"NaN", active_mark, "above: steps of the flight at the wall"}}}};
    return chart;
}

}  // namespace nsma
