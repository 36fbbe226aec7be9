#include "stability_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include <fmt/format.h>

namespace nsma {
namespace {

/// One shaded cell with a text for each value.
struct HeatMap {
    std::string name;
    std::string title;
    std::vector<std::string> rows = {};  ///< bottom to top
    std::vector<std::string> columns = {};
    std::string cells = {};  ///< rows of the data

    void add(std::size_t column, const std::string& column_name, const std::string& row, double shade,
             const std::string& text) {  // 0 light .. 1 dark
        columns.resize(std::max(columns.size(), column + 1));
        columns[column] = column_name;
        const auto height = std::find(rows.begin(), rows.end(), row) - rows.begin();
        cells += fmt::format("{} {} {:.4f} \"{}\" {}\n", column, height, shade, text, shade > 0.55 ? 0xffffff : 0);
    }
};

Axis heat_axis(const std::string& label, const std::vector<std::string>& names, bool named, const char* style) {
    std::string ticks;
    for (std::size_t i = 0; i < names.size(); ++i) {
        ticks += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_text(named ? names[i] : ""), i);
    }
    return {label, range(-0.5, static_cast<double>(names.size()) - 0.5),
            fmt::format("({}) scale 0 noenhanced {}", ticks, style)};
}

/// Which axes of a panel have ticks, and a label along x.
struct Named {
    bool rows = true;
    bool columns = true;
    const char* label = "";
};

void add_panel(Chart& chart, const Frame& frame, const HeatMap& map, const Named& named) {
    const std::string block = chart.add(map.name, map.cells);
    chart.panels.push_back(
        {.frame = frame,
         .title = map.title,
         .x = heat_axis(named.label, map.columns, named.columns, "rotate by 40 right font ',10'"),
         .y = heat_axis("", map.rows, named.rows, "font ',11'"),
         .curves = {{block + " using 1:2:(0.5):(0.5):3", "boxxy fs solid border lc rgb '#999999' fc palette"},
                    {block + " using 1:2:4:5", "labels tc rgb variable font ',9'"}}});
}

Chart heat_chart(const std::string& name, const std::string& title, int height) {
    return {.name = name,
            .settings =
                "set palette defined (0 '#f7fbff', 0.25 '#c6dbef', 0.5 '#6baed6', 0.75 '#2171b5', 1 '#08306b')\n"
                "set cbrange [0:1]\nunset colorbox\nset border 31 lc rgb '#666666'\nset style fill solid\n"
                "set title offset 0,-0.6\n",
            .title = title,
            .height = height};
}

using Records = std::vector<StabilityRecord>;

template <typename Keep>
Records filtered(const Records& records, Keep keep) {
    Records kept;
    std::copy_if(records.begin(), records.end(), std::back_inserter(kept), keep);
    return kept;
}

std::string method_of(const StabilityRecord& record) { return record.method; }
std::string size_of(const StabilityRecord& record) { return fmt::format("m = {}", record.size); }

// The first at the top.
std::vector<std::string> method_rows(const Records& records) {
    auto methods = distinct(records, method_of);
    std::reverse(methods.begin(), methods.end());
    return methods;
}

double failures(const StabilityRecord& record) {
    return record.runs == 0 ? 0.0 : 1.0 - static_cast<double>(record.outcomes[0]) / record.runs;
}

std::string success_text(const StabilityRecord& record) {
    return fmt::format("{:.0f}{}", 100 * (1 - failures(record)), record.proved ? "" : "*");
}

// As wide as a cell of a map.
std::string iterations_text(const StabilityRecord& record) {
    const double value = record.iterations;
    if (value < 1000) return fmt::format("{:.3g}", value);
    return fmt::format("{:.{}f}k", 1e-3 * value, value < 9950 ? 1 : 0);
}

// Two digits and the SI prefix of the second: 3.1µ, 86µ, 4.2m, 590m, 1.3.
std::string time_text(const StabilityRecord& record) {
    const ScaledUnit unit = scaled_unit(std::max(record.seconds, 1e-6), "");
    const double value = record.seconds * unit.factor;
    return fmt::format("{:.{}f}{}", value, value < 0.995 ? 2 : value < 9.95 ? 1 : 0, unit.unit);
}

/// What the maps of levels show, one chart each; `value` decides the shade.
struct Quantity {
    const char* chart;
    const char* title;
    double (*value)(const StabilityRecord& record);
    std::string (*text)(const StabilityRecord& record);
    bool logarithmic;  ///< shaded from the least to the greatest value; else value is the shade
};
constexpr std::array<Quantity, 3> quantities{
    {{"stability-success", "Success rate (%): replayed, and within 1e-6 of the best (*: best known, not proved)",
      failures, success_text, false},
     {"stability-iterations", "Iterations or evaluations, median",
      [](const StabilityRecord& record) { return std::max(record.iterations, 1.0); }, iterations_text, true},
     {"stability-time", "CPU time of a run (s; m: 1e-3, µ: 1e-6), median",
      [](const StabilityRecord& record) { return std::max(1e3 * record.seconds, 1e-6); }, time_text, true}}};

// One panel a method: levels along x, sizes along y.
Chart level_chart(const Records& records, const Quantity& quantity) {
    double lo = 1e300;
    double hi = 0;
    for (const auto& record : records) {
        lo = std::min(lo, quantity.value(record));
        hi = std::max(hi, quantity.value(record));
    }
    const auto shade = [&](double value) {
        if (!quantity.logarithmic) return value;
        return hi > lo ? std::log(value / lo) / std::log(hi / lo) : 0.0;
    };
    Chart chart = heat_chart(quantity.chart, quantity.title, 1150);
    const auto methods = distinct(records, method_of);
    const int rows = (static_cast<int>(methods.size()) + 1) / 2;
    for (int k = 0; k < static_cast<int>(methods.size()); ++k) {
        HeatMap map{fmt::format("panel-{}", k), methods[static_cast<std::size_t>(k)], distinct(records, size_of)};
        for (const auto& record : records) {
            if (record.method != map.title) continue;
            map.add(static_cast<std::size_t>(record.column), record.difficulty, size_of(record),
                    shade(quantity.value(record)), quantity.text(record));
        }
        const double left = k % 2 == 0 ? 0.10 : 0.555;
        const double height = 0.82 / rows;
        const int row = k / 2;
        const double top = 0.92 - row * height;
        add_panel(chart, {left, left + 0.435, top - height + 0.045, top}, map,
                  {.rows = k % 2 == 0, .columns = row == rows - 1});
    }
    return chart;
}

// What went wrong, method by method.
HeatMap causes_map(const Records& records) {
    HeatMap map{"causes", "share of runs by outcome (%)", method_rows(records)};
    for (const auto& method : map.rows) {
        std::array<int, outcome_count> outcomes{};
        int runs = 0;
        for (const auto& record : records) {
            if (record.method != method) continue;
            runs += record.runs;
            for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += record.outcomes[i];
        }
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
            const double share = static_cast<double>(outcomes[i]) / std::max(runs, 1);
            map.add(i, std::string(name(static_cast<Outcome>(i))), method, i == 0 ? 1 - share : share,
                    share > 0 ? fmt::format("{:.0f}", std::max(100 * share, 1.0)) : "");
        }
    }
    return map;
}

// One panel a difficulty: its degrees along x, methods along y. The records are of one pattern.
Chart difficulty_chart(const Records& records, const std::string& name) {
    struct Difficulty {
        const char* map;
        const char* title;
        Frame frame;
        bool names_methods;
    };
    static constexpr std::array<Difficulty, 3> difficulties{
        {{"start", "distance of the start, in radii of the energy sphere", {0.15, 0.53, 0.58, 0.90}, true},
         {"units", "unit of the objective and rows", {0.59, 0.98, 0.58, 0.90}, false},
         {"rows", "rows put back that presolve removes", {0.15, 0.53, 0.14, 0.44}, true}}};
    const Pattern& pattern = records.front().pattern;
    Chart chart =
        heat_chart(name,
                   fmt::format("Success rate (%): replayed, and within 1e-6 of the best; N = {}, r = {}, p = {}",
                               pattern.cells, pattern.free_steps, pattern.contact_steps),
                   900);
    for (const auto& difficulty : difficulties) {
        const auto shown = filtered(records, [&](const auto& record) { return record.map == difficulty.map; });
        if (shown.empty()) continue;
        HeatMap map{difficulty.map, difficulty.title, method_rows(shown)};
        for (const auto& record : shown) {
            map.add(static_cast<std::size_t>(record.column), record.difficulty, record.method, failures(record),
                    success_text(record));
        }
        add_panel(chart, difficulty.frame, map, {.rows = difficulty.names_methods});
    }
    add_panel(chart, {0.59, 0.98, 0.14, 0.44}, causes_map(records), {.rows = false});
    return chart;
}

// Dimension that each tolerance finds, less the true one.
Chart tolerance_chart(const std::vector<ToleranceRecord>& records) {
    std::map<int, int> first_free;  // the second pattern of each size has fewer classes
    for (const auto& record : records) first_free.try_emplace(record.pattern.cells, record.pattern.free_steps);
    const auto title_of = [&](const ToleranceRecord& record) {
        const bool first = record.pattern.free_steps == first_free.at(record.pattern.cells);
        return fmt::format("{}, {}", record.method, first ? "many short cycles" : "one long cycle");
    };
    const auto size_text = [](const ToleranceRecord& record) { return fmt::format("N = {}", record.pattern.cells); };
    const auto titles = distinct(records, title_of);
    const auto tolerances = distinct(records, [](const auto& record) { return record.tolerance; });
    Chart chart = heat_chart("accuracy-kernel-tolerance", "Dimension found by a dense method, less the true one", 700);
    for (std::size_t k = 0; k < titles.size(); ++k) {
        HeatMap map{fmt::format("panel-{}", k), titles[k], distinct(records, size_text)};
        for (const auto& record : records) {
            if (title_of(record) != titles[k]) continue;
            const auto column = static_cast<std::size_t>(
                std::find(tolerances.begin(), tolerances.end(), record.tolerance) - tolerances.begin());
            const int wrong = record.found - record.expected;
            const double depth = 0.35 + 0.65 * std::min(1.0, std::log10(std::abs(wrong) + 1.0) / 2.5);
            map.add(column, column % 2 == 1 ? fmt::format("{:.0e}", record.tolerance) : "", size_text(record),
                    wrong == 0 ? 0.0 : depth, wrong == 0 ? "" : fmt::format("{:+d}", wrong));
        }
        const double left = 0.09 + 0.46 * static_cast<double>(k % 2);
        const double top = k < 2 ? 0.86 : 0.47;
        add_panel(chart, {left, left + 0.43, top - 0.29, top}, map,
                  {.rows = k % 2 == 0, .columns = k + 2 >= titles.size(), .label = k >= 2 ? "tolerance" : ""});
    }
    return chart;
}

}  // namespace

std::vector<Chart> stability_charts(const AccuracyResults& results) {
    std::vector<Chart> charts;
    const auto is_level = [](const StabilityRecord& record) { return record.map == "level"; };
    const auto levels = filtered(results.stability, is_level);
    const auto others = filtered(results.stability, std::not_fn(is_level));
    for (const Quantity& quantity : quantities) {
        if (!levels.empty()) charts.push_back(level_chart(levels, quantity));
    }
    const auto patterns = distinct(others, [](const auto& record) { return record.pattern; });
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        const auto of_pattern = filtered(others, [&](const auto& record) { return record.pattern == patterns[k]; });
        charts.push_back(difficulty_chart(of_pattern, fmt::format("stability-difficulty-{}", k + 1)));
    }
    if (!results.tolerances.empty()) charts.push_back(tolerance_chart(results.tolerances));
    return charts;
}

}  // namespace nsma
