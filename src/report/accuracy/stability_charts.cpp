#include "stability_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "report/chart_blocks.hpp"
#include "report/gnuplot.hpp"

namespace nsma {
namespace {

constexpr const char* heat_head =
    "set palette defined (0 '#f7fbff', 0.25 '#c6dbef', 0.5 '#6baed6', 0.75 '#2171b5', 1 '#08306b')\n"
    "set cbrange [0:1]\nunset colorbox\nset border lc rgb '#666666'\nset style fill solid\n";

// The values that a record is drawn with.
// As wide as a cell of a map.
std::string short_number(double value) {
    if (value < 1000) return fmt::format("{:.3g}", value);
    return fmt::format("{:.{}f}k", 1e-3 * value, value < 9950 ? 1 : 0);
}

enum class Shown { failures, iterations, seconds };

template <typename Value>
int place(std::vector<Value>& seen, const Value& value) {
    const auto found = std::find(seen.begin(), seen.end(), value);
    if (found != seen.end()) return static_cast<int>(found - seen.begin());
    seen.push_back(value);
    return static_cast<int>(seen.size()) - 1;
}

double failures(const StabilityRecord& record) {
    return record.runs == 0 ? 0.0 : 1.0 - static_cast<double>(record.outcomes[0]) / record.runs;
}

double shade(double value, double lo, double hi) {
    if (!(value > 0) || !(hi > lo)) return 0.0;
    return std::clamp(std::log(value / lo) / std::log(hi / lo), 0.0, 1.0);
}

// Two digits and the SI prefix of the second: 3.1µ, 86µ, 4.2m, 590m, 1.3.
std::string short_time(double seconds) {
    const ScaledUnit unit = scaled_unit(std::max(seconds, 1e-6), "");
    const double value = seconds * unit.factor;
    return fmt::format("{:.{}f}{}", value, value < 0.995 ? 2 : value < 9.95 ? 1 : 0, unit.unit);
}

HeatMap::Cell cell(const StabilityRecord& record, Shown shown, int column, int row, double lo, double hi) {
    switch (shown) {
        case Shown::failures:
            return {column, row, failures(record),
                    fmt::format("{:.0f}{}", 100 * (1 - failures(record)), record.proved ? "" : "*")};
        case Shown::iterations: {
            const double value = std::max(record.iterations, 1.0);
            return {column, row, shade(value, lo, hi), short_number(record.iterations)};
        }
        case Shown::seconds: {
            const double value = 1e3 * record.seconds;
            return {column, row, shade(value, lo, hi), short_time(record.seconds)};
        }
    }
    return {};
}

std::vector<const StabilityRecord*> of_map(const AccuracyResults& results, const std::string& map) {
    std::vector<const StabilityRecord*> records;
    for (const auto& record : results.stability) {
        if (record.map == map) records.push_back(&record);
    }
    return records;
}

// One panel a method: levels along x, sizes along y.
Chart level_chart(const AccuracyResults& results, Shown shown, const char* name, const char* what) {
    const auto records = of_map(results, "level");
    std::vector<std::string> methods;
    std::vector<int> sizes;
    double lo = 1e300;
    double hi = 0;
    for (const auto* record : records) {
        place(methods, record->method);
        place(sizes, record->size);
        const double value = shown == Shown::seconds ? 1e3 * record->seconds : std::max(record->iterations, 1.0);
        lo = std::min(lo, std::max(value, 1e-6));
        hi = std::max(hi, value);
    }
    Chart chart{name, "", heat_head, 1150};
    chart.commands += fmt::format("set multiplot title '{}' font ',15'\n", what);
    const int columns = 2;
    const int rows = (static_cast<int>(methods.size()) + columns - 1) / columns;
    for (int k = 0; k < static_cast<int>(methods.size()); ++k) {
        HeatMap map;
        map.name = fmt::format("panel-{}", k);
        map.title = methods[static_cast<std::size_t>(k)];
        for (const int size : sizes) map.rows.push_back(k % columns == 0 ? fmt::format("m = {}", size) : "");
        for (const auto* record : records) {
            if (record->method != map.title) continue;
            if (static_cast<int>(map.columns.size()) <= record->column)
                map.columns.resize(static_cast<std::size_t>(record->column) + 1);
            map.columns[static_cast<std::size_t>(record->column)] = record->difficulty;
            map.cells.push_back(cell(*record, shown, record->column, place(sizes, record->size), lo, hi));
        }
        const int row = k / columns;
        const int column = k % columns;
        const bool last = row == rows - 1;
        if (!last) std::fill(map.columns.begin(), map.columns.end(), "");
        const double height = 0.82 / rows;
        const double top = 0.92 - row * height;
        add_heat_map(chart, map, 0.10 + 0.455 * column, 0.535 + 0.455 * column, top - height + 0.045, top);
    }
    chart.commands += "unset multiplot\n";
    return chart;
}

// One panel a difficulty: its degrees along x, methods along y.
Chart difficulty_chart(const AccuracyResults& results, const Pattern& pattern, const std::string& name) {
    static const std::array<std::pair<const char*, const char*>, 3> maps{
        {{"start", "distance of the start, in radii of the energy sphere"},
         {"units", "unit of the objective and rows"},
         {"rows", "rows put back that presolve removes"}}};
    Chart chart{name, "", heat_head, 900};
    chart.commands += fmt::format(
        "set multiplot title 'Success rate (%): replayed, and within 1e-6 of the best; N = {}, r = {}, p = {}' "
        "noenhanced font ',15'\n",
        pattern.cells, pattern.free_steps, pattern.contact_steps);
    const std::array<std::array<double, 4>, 3> frames{
        {{0.15, 0.53, 0.58, 0.90}, {0.59, 0.98, 0.58, 0.90}, {0.15, 0.53, 0.14, 0.44}}};
    for (std::size_t k = 0; k < maps.size(); ++k) {
        HeatMap map;
        map.name = maps[k].first;
        map.title = maps[k].second;
        std::vector<std::string> methods;
        for (const auto* record : of_map(results, maps[k].first)) {
            if (record->pattern == pattern) place(methods, record->method);
        }
        std::reverse(methods.begin(), methods.end());
        for (const auto* record : of_map(results, maps[k].first)) {
            if (record->pattern != pattern) continue;
            const auto column = static_cast<std::size_t>(record->column);
            if (map.columns.size() <= column) map.columns.resize(column + 1);
            map.columns[column] = record->difficulty;
            map.cells.push_back(cell(*record, Shown::failures, record->column, place(methods, record->method), 0, 1));
        }
        if (map.cells.empty()) continue;
        map.rows = k == 1 ? std::vector<std::string>(methods.size()) : methods;
        add_heat_map(chart, map, frames[k][0], frames[k][1], frames[k][2], frames[k][3]);
    }
    // What went wrong in these runs, method by method.
    HeatMap causes;
    causes.name = "causes";
    causes.title = "share of runs by outcome (%)";
    std::vector<std::string> methods;
    std::map<std::string, std::pair<std::array<int, outcome_count>, int>> counts;
    for (const auto& record : results.stability) {
        if (record.map == "level" || !(record.pattern == pattern)) continue;
        place(methods, record.method);
        auto& [outcomes, runs] = counts[record.method];
        runs += record.runs;
        for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += record.outcomes[i];
    }
    std::reverse(methods.begin(), methods.end());
    for (int i = 0; i < outcome_count; ++i) causes.columns.emplace_back(nsma::name(static_cast<Outcome>(i)));
    for (const auto& method : methods) {
        const auto& [outcomes, runs] = counts[method];
        for (int i = 0; i < outcome_count; ++i) {
            const double share = static_cast<double>(outcomes[static_cast<std::size_t>(i)]) / std::max(runs, 1);
            causes.cells.push_back({i, place(methods, method), i == 0 ? 1 - share : share,
                                    share > 0 ? fmt::format("{:.0f}", std::max(100 * share, 1.0)) : ""});
        }
    }
    causes.rows.resize(methods.size());
    add_heat_map(chart, causes, 0.59, 0.98, 0.14, 0.44);
    chart.commands += "unset multiplot\n";
    return chart;
}

// Dimension that each tolerance finds, less the true one.
Chart tolerance_chart(const AccuracyResults& results) {
    std::vector<std::pair<std::string, bool>> panels;  // method, long cycles
    std::vector<int> cells;
    std::vector<double> tolerances;
    // The second pattern of each size has fewer classes.
    std::map<std::pair<int, int>, bool> is_long;
    std::map<int, int> first_free;
    for (const auto& record : results.tolerances) {
        const int free = first_free.try_emplace(record.pattern.cells, record.pattern.free_steps).first->second;
        is_long[{record.pattern.cells, record.pattern.free_steps}] = record.pattern.free_steps != free;
        place(cells, record.pattern.cells);
        place(tolerances, record.tolerance);
        place(panels, {record.method, record.pattern.free_steps != free});
    }
    Chart chart{"accuracy-kernel-tolerance", "", heat_head, 700};
    chart.commands += "set multiplot title 'Dimension found by a dense method, less the true one' font ',15'\n";
    for (std::size_t k = 0; k < panels.size(); ++k) {
        HeatMap map;
        map.name = fmt::format("panel-{}", k);
        map.title = fmt::format("{}, {}", panels[k].first, panels[k].second ? "one long cycle" : "many short cycles");
        map.x_label = k >= 2 ? "tolerance" : "";
        for (std::size_t i = 0; i < tolerances.size(); ++i) {
            map.columns.push_back(k >= panels.size() - 2 && i % 2 == 1 ? fmt::format("{:.0e}", tolerances[i]) : "");
        }
        for (const int n : cells) map.rows.push_back(k % 2 == 0 ? fmt::format("N = {}", n) : "");
        for (const auto& record : results.tolerances) {
            const bool long_cycle = is_long[{record.pattern.cells, record.pattern.free_steps}];
            if (std::pair{record.method, long_cycle} != panels[k]) continue;
            const int wrong = record.found - record.expected;
            const double depth =
                wrong == 0 ? 0.0 : 0.35 + 0.65 * std::min(1.0, std::log10(std::abs(wrong) + 1.0) / 2.5);
            map.cells.push_back({place(tolerances, record.tolerance), place(cells, record.pattern.cells), depth,
                                 wrong == 0 ? "" : fmt::format("{:+d}", wrong)});
        }
        const double left = 0.09 + 0.46 * static_cast<double>(k % 2);
        const double top = k < 2 ? 0.86 : 0.47;
        add_heat_map(chart, map, left, left + 0.43, top - 0.29, top);
    }
    chart.commands += "unset multiplot\n";
    return chart;
}

}  // namespace

std::vector<Chart> stability_charts(const AccuracyResults& results) {
    std::vector<Chart> charts;
    if (!of_map(results, "level").empty()) {
        charts.push_back(
            level_chart(results, Shown::failures, "stability-success",
                        "Success rate (%): replayed, and within 1e-6 of the best (*: best known, not proved)"));
        charts.push_back(
            level_chart(results, Shown::iterations, "stability-iterations", "Iterations or evaluations, median"));
        charts.push_back(
            level_chart(results, Shown::seconds, "stability-time", "CPU time of a run (s; m: 1e-3, µ: 1e-6), median"));
    }
    std::vector<Pattern> patterns;
    for (const auto& record : results.stability) {
        if (record.map != "level") place(patterns, record.pattern);
    }
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        charts.push_back(difficulty_chart(results, patterns[k], fmt::format("stability-difficulty-{}", k + 1)));
    }
    if (!results.tolerances.empty()) charts.push_back(tolerance_chart(results));
    return charts;
}

}  // namespace nsma
