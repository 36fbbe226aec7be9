#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "sensitivity_folder.hpp"
#include "report/gnuplot.hpp"

namespace nsma {
namespace {

constexpr const char* axes = R"(set border 3 linecolor rgb '#333333'
set xtics out nomirror
set ytics out nomirror
)";

// Dashes, marks and greys that stay apart in print.
constexpr std::array<const char*, 6> lines{"dt 1 lc rgb '#000000'", "dt 2 lc rgb '#0072b2'", "dt 4 lc rgb '#d55e00'",
                                           "dt 1 lc rgb '#777777'", "dt 2 lc rgb '#56b4e9'", "dt 4 lc rgb '#999999'"};
constexpr std::array<int, 6> marks{7, 5, 9, 6, 4, 8};

std::string pattern_text(const Pattern& pattern) {
    return fmt::format("N = {}, r = {}, p = {}", pattern.cells, pattern.free_steps, pattern.contact_steps);
}

const char* words_of(const std::string& relaxed) {
    static const std::map<std::string, const char*, std::less<>> words{{"penetration", "COND1: penetration"},
                                                                       {"band", "COND2: band"},
                                                                       {"adhesion", "COND3: adhesion"},
                                                                       {"penetration+band", "COND1 and COND2"},
                                                                       {"penetration+adhesion", "COND1 and COND3"},
                                                                       {"band+adhesion", "COND2 and COND3"}};
    const auto found = words.find(relaxed);
    return found == words.end() ? "?" : found->second;
}

// What relaxing one row saves, relative, also where only an orbit tied with this one uses it; zero where there is no
// number.
double saving(const OptimumRecord& optimum, const Price& price) {
    return price.slope.right ? std::max(-*price.slope.right / optimum.value, 0.0) : 0.0;
}

bool is_row(const Price& price) {
    return price.parameter == Parameter::cond1_row || price.parameter == Parameter::cond3_row;
}

// How much there is to see under x_1(t): rows that save at least a tenth of what the most telling
// one saves, those in flight counted thrice.
int binding_rows(const OptimumRecord& optimum) {
    double highest = 0;
    for (const auto& price : optimum.prices) {
        if (is_row(price)) highest = std::max(highest, saving(optimum, price));
    }
    int rows = 0;
    for (const auto& price : optimum.prices) {
        if (!is_row(price) || highest <= 1e-9 || saving(optimum, price) < 0.1 * highest) continue;
        rows += price.parameter == Parameter::cond1_row ? 3 : 1;
    }
    return rows;
}

std::optional<double> right_slope(const std::vector<Price>& prices, Parameter parameter) {
    for (const auto& price : prices) {
        if (price.parameter == parameter) return price.slope.right;
    }
    return std::nullopt;
}

std::string number_or_gap(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "NaN"; }

// A step of 1, 2 or 5 times a power of ten that divides the range into three to six.
double tic_step(double range) {
    const double power = std::pow(10.0, std::floor(std::log10(range / 3)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * power <= range / 3) return factor * power;
    }
    return power;
}

}  // namespace

Chart binding_chart(const Scene& scene, const OptimumRecord& optimum) {
    const Pattern& pattern = optimum.orbit.kernel.pattern;
    const double cells = pattern.cells;
    const Eigen::VectorXd tip = tip_history(optimum.orbit.kernel, optimum.orbit.beta);
    const double wall = scene.bar.gap_sign();
    const double period = pattern.period_ratio();
    Chart chart{"binding",
                fmt::format("# {}: time t/tau, x_1/u; then step time and saving [% of the objective per % of |d| or "
                            "of Y S |d|/L]\n# tip\n",
                            scene.title),
                ""};
    for (Eigen::Index n = 0; n < tip.size(); ++n)
        chart.data += fmt::format("{} {}\n", static_cast<double>(n) / cells, tip[n]);
    double highest = 0;
    const auto bars = [&](const char* index, Parameter parameter) {
        bool any = false;
        chart.data += fmt::format("\n\n# {}\nNaN 0\n", index);
        for (const auto& price : optimum.prices) {
            if (price.parameter != parameter) continue;
            const double height = saving(optimum, price);
            if (height <= 1e-9) continue;
            highest = std::max(highest, height);
            any = true;
            for (const int step : price.steps) {
                const double middle = parameter == Parameter::cond3_row ? 0.5 : 0.0;
                chart.data += fmt::format("{} {}\n", (step + middle) / cells, height);
            }
        }
        return any;
    };
    const bool wall_decides = bars("wall", Parameter::cond1_row);
    const bool push_decides = bars("push", Parameter::cond3_row);
    chart.data += "\n\n# active\nNaN 0\n";
    for (const auto& price : optimum.prices) {
        if (price.parameter != Parameter::cond1_row || !price.active) continue;
        for (const int step : price.steps) chart.data += fmt::format("{} {}\n", step / cells, tip[step]);
    }
    std::string elasticities;
    for (const auto& [parameter, words] :
         {std::pair{Parameter::gap, "gap"}, std::pair{Parameter::contact, "place of contact"},
          std::pair{Parameter::energy, "energy"}}) {
        const auto slope = right_slope(optimum.prices, parameter);
        if (!slope) continue;
        const double relative = elasticity(*slope, parameter, optimum.value, scene.bar.gap_sign(),
                                           optimum.level.value_or(energy_ratio(optimum.orbit)));
        elasticities +=
            fmt::format("{}{} {:+.3g}", elasticities.empty() ? "elasticity of the objective: " : ", ", words, relative);
    }
    const bool narrow = 8 * pattern.contact_steps < pattern.period_steps();  // for the word
    const double lowest = tip.minCoeff();
    const double head = 0.14 * std::max(wall - lowest, 1e-9);
    const std::string title =
        fmt::format("Where the wall decides: {}, {}{}", name(optimum.objective), pattern_text(pattern),
                    optimum.level ? fmt::format(", E = {:.3g} E_g", *optimum.level) : "");
    chart.commands = fmt::format(
        R"(set multiplot
{axes}set lmargin screen 0.12
set rmargin screen 0.97
set xrange [0:{period}]
set tmargin screen 0.92
set bmargin screen 0.55
set title {title}
set format x ''
set ylabel 'x_1/|d|' offset 0.5,0
set yrange [{lowest}:{top}]
set object 1 rectangle from graph 0, first {wall} to graph 1, graph 1 behind fillcolor rgb '#dddddd' fillstyle solid noborder
set object 2 rectangle from first {free}, graph 0 to first {period}, first {wall} behind fillcolor rgb '#f2f2f2' fillstyle solid noborder
set label 1 'wall' at graph 0.5, first {label} center textcolor rgb '#333333'
set label 2 'contact' at first {contact_at}, graph 0.06 {contact_side} textcolor rgb '#555555'
unset key
plot {wall} with lines lw 1 lc rgb '#333333', 'binding.dat' index 0 using 1:2 with lines lw 2 lc rgb '#000000', \
     'binding.dat' index 3 using 1:2 with points pt 7 ps 0.9*mark lc rgb '#d55e00'
unset object
unset label
unset title
set tmargin screen 0.50
set bmargin screen 0.24
set format x '%g'
set xlabel 'time t/τ, τ = L/c'
set ylabel "saved [%]" offset 0.5,0
set yrange [0:{highest}]
set ytics {tic}
set boxwidth {width}
set label 3 {elasticities} at graph 0.01, graph 1.08 left noenhanced textcolor rgb '#333333'
set key at screen 0.545, screen 0.11 center top vertical maxrows 3 Left reverse samplen 3
plot 'binding.dat' index 1 using 1:2 with boxes lc rgb '#d55e00' fillstyle solid 0.8 border lc rgb '#d55e00' title '{flight_words}', \
     'binding.dat' index 2 using 1:2 with boxes lc rgb '#000000' fillstyle pattern 4 border lc rgb '#000000' title '{contact_words}', \
     NaN with points pt 7 ps 0.9*mark lc rgb '#d55e00' title 'above: steps of the flight at the wall'
unset multiplot
)",
        fmt::arg("axes", axes), fmt::arg("period", period), fmt::arg("title", gnuplot_text(title)),
        fmt::arg("lowest", lowest - 0.5 * head), fmt::arg("top", wall + head), fmt::arg("wall", wall),
        fmt::arg("label", wall + 0.5 * head), fmt::arg("free", pattern.free_steps / cells),
        fmt::arg("contact_at", narrow ? period : (pattern.free_steps + 0.5 * pattern.contact_steps) / cells),
        fmt::arg("contact_side", narrow ? "right" : "center"), fmt::arg("highest", highest > 0 ? 1.15 * highest : 1.0),
        fmt::arg("width", 0.7 / cells), fmt::arg("elasticities", gnuplot_text(elasticities)),
        fmt::arg("flight_words", wall_decides ? "COND1: saved per penetration of 1 % of |d| at this step"
                                              : "COND1: no step of the flight has a price"),
        fmt::arg("contact_words", push_decides ? "COND3: saved per tension of 1 % of YS|d|/L at this step"
                                               : "COND3: no step of contact has a price"),
        fmt::arg("tic", tic_step(highest > 0 ? highest : 1.0)));
    return chart;
}

Chart relaxation_chart(const Scene& scene, const SensitivityRecords& records, const IntervalRecord& interval,
                       const OptimumRecord* optimum) {
    Chart chart{
        "relaxation",
        fmt::format("# {}: amount (of |d|; of Y S |d|/L), E_min/E_g, E_max/E_g, objective over its value at zero, "
                    "then the tangents of these at zero\n",
                    scene.title),
        ""};
    std::array<std::string, 3> panels;
    double reach = 0;
    const std::vector<Price> none;
    const auto& objective_prices = optimum != nullptr ? optimum->prices : none;
    // Pairs below, so that the single conditions and their tangents are seen.
    constexpr std::array relaxed_names{
        "penetration+band", "penetration+adhesion", "band+adhesion", "penetration", "band", "adhesion"};
    for (std::size_t i = 0; i < relaxed_names.size(); ++i) {
        const std::string relaxed = relaxed_names.at(i);
        const bool single = i >= 3;
        const std::size_t style = (i + 3) % 6;
        const Parameter parameter = i == 3 ? Parameter::penetration : i == 4 ? Parameter::band : Parameter::adhesion;
        const auto tangent = [&](const std::vector<Price>& prices, double value, double unit, double amount) {
            const auto slope = single ? right_slope(prices, parameter) : std::nullopt;
            return number_or_gap(slope ? std::optional((value + *slope * amount) / unit) : std::nullopt);
        };
        chart.data += fmt::format("\n\n# {}\nNaN NaN NaN NaN NaN NaN NaN\n", relaxed);
        for (const auto& record : records.curves) {
            if (!(record.pattern == interval.pattern) || record.relaxed != relaxed || !record.least) continue;
            reach = std::max(reach, record.amount);
            std::optional<double> objective;
            if (optimum != nullptr && record.objective) objective = *record.objective / optimum->value;
            const double value = optimum != nullptr ? optimum->value : 1.0;
            chart.data += fmt::format(
                "{} {} {} {} {} {} {}\n", record.amount, *record.least, number_or_gap(record.greatest),
                number_or_gap(objective), tangent(interval.least_prices, interval.least, 1.0, record.amount),
                tangent(interval.greatest_prices, interval.greatest.value_or(0), 1.0, record.amount),
                tangent(objective_prices, value, value, record.amount));
        }
        for (std::size_t panel = 0; panel < 3; ++panel) {
            panels.at(panel) += fmt::format(
                "{}'relaxation.dat' index {} using 1:{} with linespoints lw 2 pt {} ps {}*mark {}",
                i == 0 ? "" : ", \\\n     ", i, 2 + panel, marks.at(style), single ? 0.9 : 1.5, lines.at(style));
            if (single) {
                panels.at(panel) += fmt::format(
                    ", \\\n     'relaxation.dat' index {} using 1:{} with lines lw 1.5 dt 3 lc rgb '#333333'", i,
                    5 + panel);
            }
        }
    }
    std::string legend = "NaN with lines lw 1.5 dt 3 lc rgb '#333333' title 'tangents at zero, from the multipliers'";
    for (const auto& [relaxed, style] :
         {std::pair{"penetration", 0U}, std::pair{"band", 1U}, std::pair{"adhesion", 2U},
          std::pair{"penetration+band", 3U}, std::pair{"penetration+adhesion", 4U}, std::pair{"band+adhesion", 5U}}) {
        legend += fmt::format(", \\\n     NaN with linespoints lw 2 pt {} ps {}*mark {} title '{}'", marks.at(style),
                              style < 3 ? 0.9 : 1.5, lines.at(style), words_of(relaxed));
    }
    const std::string level =
        optimum != nullptr && optimum->level ? fmt::format(" at E = {:.3g} E_g", *optimum->level) : "";
    chart.commands = fmt::format(
        R"(set multiplot
{axes}unset key
set label 1 {title} at screen 0.5, screen 0.965 center
set xrange [0:{reach}]
set yrange [0:*]
set lmargin screen 0.09
set rmargin screen 0.48
set tmargin screen 0.88
set bmargin screen 0.58
set title 'least energy E_{{min}}/E_g'
plot {least}
unset label 1
set lmargin screen 0.59
set rmargin screen 0.98
set title 'greatest energy E_{{max}}/E_g'
set xlabel 'amount allowed: length/|d|, tension/(YS|d|/L)'
plot {greatest}
set lmargin screen 0.09
set rmargin screen 0.48
set tmargin screen 0.43
set bmargin screen 0.13
set yrange [0:1.05]
set title {objective}
plot {objectives}
unset title
unset xlabel
set border 0
unset xtics
unset ytics
set key at screen 0.58, screen 0.38 left top vertical maxrows 7 Left reverse samplen 4
plot [0:1] [0:1] {legend}
unset multiplot
)",
        fmt::arg("axes", axes), fmt::arg("reach", reach > 0 ? 1.02 * reach : 1.0),
        fmt::arg("title",
                 gnuplot_text("Allowing penetration, a band of contact, tension: " + pattern_text(interval.pattern))),
        fmt::arg("objective", gnuplot_text(fmt::format("{}{}, relative", name(scene.objective), level))),
        fmt::arg("least", panels[0]), fmt::arg("greatest", panels[1]), fmt::arg("objectives", panels[2]),
        fmt::arg("legend", legend));
    return chart;
}

Chart count_chart(const Scene& scene, const SensitivityRecords& records) {
    Chart chart{"counts",
                fmt::format("# {}: amount (of |d|; of Y S |d|/L), number of admissible patterns\n", scene.title), ""};
    std::map<std::string, std::map<double, int>> counts;
    std::vector<std::string> order;
    double reach = 0;
    int highest = 1;
    for (const auto& record : records.curves) {
        if (std::find(order.begin(), order.end(), record.relaxed) == order.end()) order.push_back(record.relaxed);
        highest = std::max(highest, counts[record.relaxed][record.amount] += record.admissible ? 1 : 0);
        reach = std::max(reach, record.amount);
    }
    std::string curves;
    for (std::size_t i = 0; i < order.size(); ++i) {
        chart.data += fmt::format("\n\n# {}\n", order[i]);
        for (const auto& [amount, count] : counts[order[i]]) chart.data += fmt::format("{} {}\n", amount, count);
        curves += fmt::format("{}'counts.dat' index {} using 1:2 with linespoints lw 2 pt {} ps 0.8*mark {} title '{}'",
                              i == 0 ? "" : ", \\\n     ", i, marks.at(i % 6), lines.at(i % 6), words_of(order[i]));
    }
    chart.commands = fmt::format(
        R"({axes}set title {title} noenhanced
set xlabel 'amount allowed (of |d|; adhesion of YS|d|/L)'
set ylabel 'admissible patterns'
set xrange [0:{reach}]
set yrange [0:{highest}]
set bmargin screen 0.26
set key at screen 0.53, screen 0.12 center top vertical maxrows 2 Left reverse samplen 4
plot {curves}
)",
        fmt::arg("axes", axes),
        fmt::arg("title", gnuplot_text(scene.title + ": admissible patterns when conditions are relaxed")),
        fmt::arg("reach", reach > 0 ? 1.02 * reach : 1.0), fmt::arg("highest", std::ceil(1.1 * highest)),
        fmt::arg("curves", curves));
    return chart;
}

Chart funnel_chart(const Scene& scene, const SensitivityRecords& records) {
    Chart chart{"funnel", fmt::format("# {}: place, patterns left, condition imposed\n", scene.title), ""};
    const auto all = funnels(records.ablations);
    const int kernel = all.empty() ? 0 : all.front().left[0];
    std::array<std::string, 4> series;  // the kernel, then COND1..COND3
    std::string numbers, ticks;
    for (std::size_t k = 0; k < all.size(); ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
            const double place = 5.0 * static_cast<double>(k) + static_cast<double>(i);
            const auto which = i == 0 ? 0 : static_cast<std::size_t>(all[k].order[i - 1]);
            series.at(which) += fmt::format("{} {}\n", place, all[k].left[i]);
            numbers += fmt::format("{} {}\n", place, all[k].left[i]);
        }
        ticks += fmt::format("{}'{}, {}, {}' {}", k == 0 ? "" : ", ", all[k].order[0], all[k].order[1], all[k].order[2],
                             5.0 * static_cast<double>(k) + 1.5);
    }
    for (const auto& one : series) chart.data += "\n\n" + one;
    chart.data += "\n\n" + numbers;
    chart.commands = fmt::format(
        R"({axes}set title {title} noenhanced
set xlabel 'order in which COND1, COND2, COND3 are imposed'
set ylabel 'patterns left'
set xtics ({ticks}) scale 0
set xrange [-1:29]
set yrange [0:{highest}]
set boxwidth 0.9
set bmargin screen 0.20
set key at screen 0.53, screen 0.06 center horizontal samplen 2 Left reverse
plot 'funnel.dat' index 0 using 1:2 with boxes lc rgb '#bbbbbb' fillstyle solid 0.4 border lc rgb '#777777' title 'kernel', \
     'funnel.dat' index 1 using 1:2 with boxes lc rgb '#222222' fillstyle solid 0.9 border lc rgb '#222222' title 'after COND1', \
     'funnel.dat' index 2 using 1:2 with boxes lc rgb '#000000' fillstyle pattern 4 border lc rgb '#000000' title 'after COND2', \
     'funnel.dat' index 3 using 1:2 with boxes lc rgb '#d55e00' fillstyle solid 0.7 border lc rgb '#d55e00' title 'after COND3', \
     'funnel.dat' index 4 using 1:2:2 with labels offset 0,0.6 font ',11' notitle
)",
        fmt::arg("axes", axes), fmt::arg("title", gnuplot_text(scene.title + ": patterns that each condition leaves")),
        fmt::arg("ticks", ticks), fmt::arg("highest", 1.12 * std::max(kernel, 1)));
    return chart;
}

std::vector<std::filesystem::path> draw_sensitivity(const std::filesystem::path& folder, const Scene& scene,
                                                    const SensitivityRecords& records) {
    const std::filesystem::path charts = folder / "charts";
    std::vector<std::filesystem::path> drawn;
    const auto draw = [&](const Chart& chart) {
        draw_chart(chart, charts);
        drawn.push_back(charts / (chart.name + ".svg"));
        drawn.push_back(charts / (chart.name + ".png"));
    };
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
    if (telling != nullptr) draw(binding_chart(scene, *telling));
    const IntervalRecord* interval = nullptr;
    for (const auto& record : records.intervals) {
        const bool same = telling != nullptr && record.pattern == telling->orbit.kernel.pattern;
        if (interval == nullptr || same) interval = &record;
    }
    if (interval != nullptr && !records.curves.empty()) {
        const bool at_level =
            telling != nullptr && telling->level && telling->orbit.kernel.pattern == interval->pattern;
        draw(relaxation_chart(scene, records, *interval, at_level ? telling : nullptr));
    }
    if (records.ablations.size() > 1) {
        if (!records.curves.empty()) draw(count_chart(scene, records));
        draw(funnel_chart(scene, records));
    }
    return drawn;
}

}  // namespace nsma
