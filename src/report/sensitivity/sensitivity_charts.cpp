#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "sensitivity_charts.hpp"

namespace nsma {
namespace {

/// A relaxation as the records name it. Single conditions have a parameter, whose multiplier is the curve's tangent.
struct RelaxationCurve {
    const char* name;
    const char* words;
    std::optional<Parameter> single;

    [[nodiscard]] double mark_size() const { return single ? 0.9 : 1.5; }
};
constexpr std::array<RelaxationCurve, 6> relaxations{{{"penetration", "COND1: penetration", Parameter::penetration},
                                                      {"band", "COND2: band", Parameter::band},
                                                      {"adhesion", "COND3: adhesion", Parameter::adhesion},
                                                      {"penetration+band", "COND1 and COND2", std::nullopt},
                                                      {"penetration+adhesion", "COND1 and COND3", std::nullopt},
                                                      {"band+adhesion", "COND2 and COND3", std::nullopt}}};
constexpr const char* tangent_style = "lines lw 1.5 dt 3 lc rgb '#333333'";

std::string number_or_gap(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "NaN"; }

/// The curves of one pattern under one relaxation: amount, E_min/E_g, E_max/E_g, objective over its value at zero, then
/// the tangents of these at zero.
std::string relaxation_rows(const std::vector<CurveRecord>& curves, const RelaxationCurve& relaxation,
                            const IntervalRecord& interval, const OptimumRecord* optimum) {
    const std::vector<Price> none;
    const double value = optimum != nullptr ? optimum->value : 1.0;
    std::string rows;
    for (const auto& record : curves) {
        if (record.pattern != interval.pattern || record.relaxed != relaxation.name || !record.least) continue;
        const auto tangent = [&](const std::vector<Price>& prices, double at_zero, double unit) {
            const auto slope = relaxation.single ? right_slope(prices, *relaxation.single) : std::nullopt;
            return slope ? fmt::format("{}", (at_zero + *slope * record.amount) / unit) : "NaN";
        };
        std::optional<double> objective;
        if (optimum != nullptr && record.objective) objective = *record.objective / value;
        rows += fmt::format("{} {} {} {} {} {} {}\n", record.amount, *record.least, number_or_gap(record.greatest),
                            number_or_gap(objective), tangent(interval.least_prices, interval.least, 1.0),
                            tangent(interval.greatest_prices, interval.greatest.value_or(0), 1.0),
                            tangent(optimum != nullptr ? optimum->prices : none, value, value));
    }
    return rows;
}

}  // namespace

Chart relaxation_chart(const Scene& scene, const SensitivityRecords& records, const IntervalRecord& interval,
                       const OptimumRecord* optimum) {
    Chart chart{.name = "relaxation",
                .data = fmt::format("# {}: amount (of |d|; of Y S |d|/L), E_min/E_g, E_max/E_g, objective over its "
                                    "value at zero, then the tangents of these at zero\n",
                                    scene.title),
                .settings = "set title enhanced\n"};
    double reach = 0;
    for (const auto& record : records.curves) {
        if (record.pattern == interval.pattern && record.least) reach = std::max(reach, record.amount);
    }
    const std::string amounts = range(0.0, reach > 0 ? 1.02 * reach : 1.0);
    const char* amount_label = "amount allowed: length/|d|, tension/(YS|d|/L)";
    chart.panels = {
        {.frame = Frame{0.09, 0.48, 0.58, 0.88},
         .title = "least energy E_{min}/E_g",
         .x = {"", amounts},
         .y = {"", "0:*"},
         .settings = fmt::format(
             "set label {} at screen 0.5, screen 0.975 center\n",
             gnuplot_text("Allowing penetration, a band of contact, tension: " + text_of(interval.pattern)))},
        {.frame = Frame{0.59, 0.98, 0.58, 0.88},
         .title = "greatest energy E_{max}/E_g",
         .x = {amount_label, amounts},
         .y = {"", "0:*"}},
        {.frame = Frame{0.09, 0.48, 0.13, 0.43},
         .title = fmt::format("{}{}, relative", name(scene.objective),
                              optimum != nullptr ? level_text(" at ", *optimum) : ""),
         .x = {amount_label, amounts},
         .y = {"", "0:1.05"}},
        legend({0.59, 0.98, 0.13, 0.43}, "at screen 0.58, screen 0.38 left top vertical maxrows 7 samplen 4",
               {{"NaN", tangent_style, "tangents at zero (multipliers)"}})};
    if (optimum == nullptr) {  // no objective to show
        chart.panels.erase(chart.panels.begin() + 2);
        chart.panels.front().x.label = amount_label;
    }
    // Pairs below, so that the single conditions and their tangents are seen.
    for (const std::size_t i : {3U, 4U, 5U, 0U, 1U, 2U}) {
        const RelaxationCurve& relaxation = relaxations.at(i);
        const std::string block =
            chart.add(relaxation.name, relaxation_rows(records.curves, relaxation, interval, optimum));
        for (std::size_t panel = 0; panel + 1 < chart.panels.size(); ++panel) {
            auto& curves = chart.panels[panel].curves;
            curves.push_back({fmt::format("{} using 1:{}", block, 2 + panel),
                              marked_line(curve_styles.at(i), relaxation.mark_size())});
            if (relaxation.single) curves.push_back({fmt::format("{} using 1:{}", block, 5 + panel), tangent_style});
        }
    }
    for (std::size_t i = 0; i < relaxations.size(); ++i) {
        chart.panels.back().curves.push_back(
            {"NaN", marked_line(curve_styles.at(i), relaxations.at(i).mark_size()), relaxations.at(i).words});
    }
    return chart;
}

Chart count_chart(const Scene& scene, const SensitivityRecords& records) {
    std::map<std::string, std::map<double, int>> counts;
    std::vector<std::string> order;
    double reach = 0;
    int highest = 1;
    for (const auto& record : records.curves) {
        if (std::find(order.begin(), order.end(), record.relaxed) == order.end()) order.push_back(record.relaxed);
        highest = std::max(highest, counts[record.relaxed][record.amount] += record.admissible ? 1 : 0);
        reach = std::max(reach, record.amount);
    }
    Chart chart{
        .name = "counts",
        .data = fmt::format("# {}: amount (of |d|; of Y S |d|/L), number of admissible patterns\n", scene.title)};
    Panel panel{.title = scene.title + ": admissible patterns when conditions are relaxed",
                .x = {"amount allowed (of |d|; adhesion of YS|d|/L)", range(0.0, reach > 0 ? 1.02 * reach : 1.0)},
                .y = {"admissible patterns", range(0.0, std::ceil(1.1 * highest))},
                .key = "at screen 0.53, screen 0.12 center top vertical maxrows 2 samplen 4",
                .settings = "set bmargin screen 0.26\n"};
    for (std::size_t i = 0; i < order.size(); ++i) {
        std::string rows;
        for (const auto& [amount, count] : counts[order[i]]) rows += fmt::format("{} {}\n", amount, count);
        const auto known = std::find_if(relaxations.begin(), relaxations.end(),
                                        [&](const RelaxationCurve& relaxation) { return order[i] == relaxation.name; });
        panel.curves.push_back({chart.add(order[i], rows) + " using 1:2", marked_line(curve_styles.at(i % 6), 0.8),
                                known == relaxations.end() ? "?" : known->words});
    }
    chart.panels = {panel};
    return chart;
}

Chart funnel_chart(const Scene& scene, const SensitivityRecords& records) {
    struct Bars {
        const char* title;
        const char* style;
    };
    static constexpr std::array<Bars, 4> bars{
        {{"kernel", "boxes lc rgb '#bbbbbb' fillstyle solid 0.4 border lc rgb '#777777'"},
         {"after COND1", "boxes lc rgb '#222222' fillstyle solid 0.9 border lc rgb '#222222'"},
         {"after COND2", "boxes lc rgb '#000000' fillstyle pattern 4 border lc rgb '#000000'"},
         {"after COND3", "boxes lc rgb '#d55e00' fillstyle solid 0.7 border lc rgb '#d55e00'"}}};
    std::array<std::string, bars.size()> rows;
    std::string numbers, ticks;
    double place = 0;
    int most = 1;
    for (const Funnel& funnel : funnels(records.ablations)) {
        ticks += fmt::format("{}'{}, {}, {}' {}", ticks.empty() ? "" : ", ", funnel.order[0], funnel.order[1],
                             funnel.order[2], place + 1.5);
        for (std::size_t i = 0; i < bars.size(); ++i) {
            const std::string row = fmt::format("{} {}\n", place++, funnel.left[i]);
            rows.at(i == 0 ? 0 : static_cast<std::size_t>(funnel.order[i - 1])) += row;
            numbers += row;
        }
        ++place;  // between two funnels
        most = std::max(most, funnel.left[0]);
    }
    Chart chart{.name = "funnel", .data = fmt::format("# {}: place, patterns left\n", scene.title)};
    Panel panel{.title = scene.title + ": patterns that each condition leaves",
                .x = {"order in which COND1, COND2, COND3 are imposed", "-1:29", fmt::format("({}) scale 0", ticks)},
                .y = {"patterns left", range(0.0, 1.12 * most)},
                .key = "at screen 0.53, screen 0.06 center horizontal samplen 2",
                .settings = "set boxwidth 0.9\nset bmargin screen 0.20\n"};
    for (std::size_t i = 0; i < bars.size(); ++i) {
        panel.curves.push_back(
            {chart.add(bars.at(i).title, rows.at(i)) + " using 1:2", bars.at(i).style, bars.at(i).title});
    }
    panel.curves.push_back({chart.add("all", numbers) + " using 1:2:2", "labels offset 0,0.6 font ',11'"});
    chart.panels = {panel};
    return chart;
}

namespace {

// Else all curves of the counts are one level line.
bool counts_differ(const std::vector<CurveRecord>& curves) {
    std::map<std::pair<std::string, double>, int> counts;
    for (const CurveRecord& point : curves) counts[{point.relaxed, point.amount}] += point.admissible ? 1 : 0;
    return std::any_of(counts.begin(), counts.end(),
                       [&](const auto& entry) { return entry.second != counts.begin()->second; });
}

// Else all bars of the funnel are one.
bool conditions_refuse(const std::vector<AblationRecord>& records) {
    return std::any_of(records.begin(), records.end(),
                       [](const AblationRecord& record) { return record.survives.front() && !record.survives.back(); });
}

}  // namespace

std::vector<Chart> sensitivity_charts(const Scene& scene, const SensitivityRecords& records) {
    std::vector<Chart> charts;
    // The optimum that most rows hold; at the level of its relaxation curves where there are any.
    const auto on_curve = [&](const OptimumRecord& record) {
        return std::any_of(records.curves.begin(), records.curves.end(), [&](const CurveRecord& point) {
            return point.pattern == record.orbit.kernel.pattern && point.level && point.level == record.level;
        });
    };
    const OptimumRecord* telling = nullptr;
    int most = -1;
    for (const auto& record : records.optima) {
        const int rows = binding_rows(record) + (on_curve(record) ? 1000 : 0);
        if (rows > most) {
            most = rows;
            telling = &record;
        }
    }
    if (telling != nullptr) charts.push_back(binding_chart(scene, *telling));
    const IntervalRecord* interval = nullptr;
    for (const auto& record : records.intervals) {
        const bool same = telling != nullptr && record.pattern == telling->orbit.kernel.pattern;
        if (interval == nullptr || same) interval = &record;
    }
    if (interval != nullptr && !records.curves.empty()) {
        const bool at_level =
            telling != nullptr && telling->level && telling->orbit.kernel.pattern == interval->pattern;
        charts.push_back(relaxation_chart(scene, records, *interval, at_level ? telling : nullptr));
    }
    if (records.ablations.size() > 1) {
        if (counts_differ(records.curves)) charts.push_back(count_chart(scene, records));
        if (conditions_refuse(records.ablations)) charts.push_back(funnel_chart(scene, records));
    }
    return charts;
}

}  // namespace nsma
