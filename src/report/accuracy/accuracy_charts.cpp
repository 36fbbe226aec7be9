#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "accuracy_folder.hpp"
#include "stability_charts.hpp"

namespace nsma {
namespace {

constexpr double smallest_contact_error = 1e-4;  // what an error of zero is drawn at

double drawn(double error) { return std::max(error, 1e-17); }

std::string log_axes(const char* title_offset) {
    return fmt::format(
        "set logscale xy\nset format x '10^{{%L}}'\nset format y '10^{{%L}}'\n"
        "set grid xtics ytics lc rgb '#e4e4e4' lt 1\nset title offset {}\nset ylabel offset 1,0\n",
        title_offset);
}

// The legend below all panels, with this many entries in a column.
Panel legend_below(double top, int rows, std::vector<Curve> entries) {
    return legend({0.02, 0.98, 0.0, top},
                  fmt::format("center center vertical maxrows {} samplen 2.5 width -4 font ',11'", rows),
                  std::move(entries));
}

std::string program_label(const ProgramRecord& record) { return record.method + (record.warm ? ", warm start" : ""); }

// The shape tells the method; filled marks are of certified answers only.
std::string program_style(const std::string& label, bool certified) {
    if (label == "both solvers") return "points pt 3 ps 2.2*mark lw 2.5 lc rgb '#000000'";
    if (label == "default") return "points pt 1 ps 2.2*mark lw 2.5 lc rgb '#000000'";
    if (label == "segment") return "points pt 2 ps 1.7*mark lw 2.5 lc rgb '#d55e00'";
    struct Shape {
        const char* label;
        int hollow;
        double size;
        const char* colour;
    };
    static constexpr std::array<Shape, 7> shapes{{{"Ipopt, warm start", 6, 0.8, "#56b4e9"},
                                                  {"Ipopt", 6, 1.4, "#0072b2"},
                                                  {"SLSQP", 8, 1.4, "#b8500a"},
                                                  {"AUGLAG+LBFGS", 4, 1.3, "#009e73"},
                                                  {"AUGLAG+SLSQP", 12, 1.4, "#7a5195"},
                                                  {"COBYLA", 10, 1.4, "#555555"},
                                                  {"ISRES", 4, 0.7, "#555555"}}};
    const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const Shape& one) { return label == one.label; });
    if (shape == shapes.end()) return "points pt 1 ps mark lc rgb '#999999'";
    return fmt::format("points pt {} ps {}*mark lw 1.8 lc rgb '{}'", shape->hollow + (certified ? 1 : 0), shape->size,
                       shape->colour);
}

double drawn_error(const ProgramRecord& record) { return std::clamp(record.error, 1e-15, 10.0); }

// The stairs below which no method gets.
std::string stairs(const std::vector<const ProgramRecord*>& front, double right) {
    std::string rows;
    double least = 30;
    for (const auto* record : front) {
        if (drawn_error(*record) >= least) continue;
        rows +=
            fmt::format("{} {}\n{} {}\n", record->seconds.median, least, record->seconds.median, drawn_error(*record));
        least = drawn_error(*record);
    }
    return rows.empty() ? rows : rows + fmt::format("{} {}\n", right, least);
}

/// Records under one label of the key, as rows of the data.
struct Series {
    std::string label;
    std::string rows;
};

template <typename Record, typename Label, typename Row>
std::vector<Series> series_of(const std::vector<Record>& records, Label label_of, Row row) {
    std::vector<Series> all;
    for (const auto& label : distinct(records, label_of)) {
        all.push_back({label, ""});
        for (const auto& record : records) {
            if (label_of(record) == label) all.back().rows += row(record);
        }
    }
    return all;
}

constexpr const char* any_front = "lines lw 2 dt 3 lc rgb '#888888'";
constexpr const char* certified_front = "lines lw 2.5 dt 1 lc rgb '#bbbbbb'";

std::vector<Curve> program_curves(Chart& chart, const std::vector<ProgramRecord>& records, int size, double right) {
    const auto front = [&](const char* name, bool certified) {
        return chart.add(fmt::format("{}-{}", name, size), stairs(pareto_front(records, size, certified), right)) +
               " using 1:2";
    };
    std::vector<Curve> curves{{front("certified-front", true), certified_front}, {front("front", false), any_front}};
    for (const bool certified : {false, true}) {
        auto all = series_of(records, program_label, [&](const ProgramRecord& record) {
            if (record.size != size || all_certified(record) != certified) return std::string();
            return fmt::format("{} {} {} {}\n", record.seconds.median, drawn_error(record), record.seconds.low,
                               record.seconds.high);
        });
        std::reverse(all.begin(), all.end());  // the first ones on top
        for (const auto& [label, rows] : all) {
            if (rows.empty()) continue;
            const std::string block =
                chart.add(fmt::format("{} {} {}", certified ? "certified" : "any", size, label), rows);
            curves.push_back({block + " using 1:2:3:4", "xerrorbars pt 0 lw 1 lc rgb '#999999'"});
            curves.push_back({block + " using 1:2", program_style(label, certified)});
        }
    }
    return curves;
}

Chart program_chart(const std::vector<ProgramRecord>& records) {
    const auto sizes = distinct(records, [](const ProgramRecord& record) { return record.size; });
    const auto rows = (sizes.size() + 1) / 2;
    const double below = 260;  // title and legend
    const double row_height = 400;
    Chart chart{.name = "accuracy-programs",
                .settings = log_axes("0,-0.7") + "set xlabel offset 0,0.5\n",
                .title = "One orbit at a given energy: CPU time against error, by number m of amplitudes",
                .height = static_cast<int>(below + row_height * static_cast<double>(rows))};
    std::vector<Curve> entries;
    double slowest = 1e-4;
    double fastest = 1e4;
    double largest = 1e-15;
    for (const auto& record : records) {
        largest = std::max(largest, drawn_error(record));
        slowest = std::max(slowest, record.seconds.high);
        fastest = std::min(fastest, std::max(record.seconds.low, 1e-7));
    }
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const double left = k % 2 == 0 ? 0.10 : 0.59;
        const std::size_t row = k / 2;
        const double top = 1 - (75 + row_height * static_cast<double>(row)) / chart.height;
        chart.panels.push_back({.frame = Frame{left, left + 0.39, top - 320.0 / chart.height, top},
                                .title = fmt::format("m = {}", sizes[k]),
                                .x = {.label = k + 2 < sizes.size() ? "" : "CPU time of a run (s)",
                                      .range = range(fastest / 2, slowest * 2)},
                                .y = {.label = "largest error", .range = range(2e-16, 3 * largest)},
                                .curves = program_curves(chart, records, sizes[k], slowest * 2)});
    }
    for (const auto& label : distinct(records, program_label)) {
        entries.push_back({"NaN", program_style(label, true), label});
    }
    entries.push_back({"NaN", program_style("Ipopt", false), "hollow: not all certified"});
    entries.push_back({"NaN", certified_front, "Pareto front, certified"});
    entries.push_back({"NaN", any_front, "Pareto front, any"});
    chart.panels.push_back(legend_below(170.0 / chart.height, 5, std::move(entries)));
    return chart;
}

// How a method is drawn in every panel: marker, dash and shade differ, so that grey print does.
std::string method_style(std::size_t index) {
    static constexpr std::array<int, 10> points{7, 5, 9, 11, 13, 6, 4, 8, 10, 12};
    static constexpr std::array<const char*, 10> colours{"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                         "#56b4e9", "#e69f00", "#444444", "#7a5195", "#8c564b"};
    const std::size_t k = index % points.size();
    return fmt::format("linespoints pt {} dt {} ps 1.1*mark lw 1.6 lc rgb '{}'", points.at(k), 1 + index % 5,
                       colours.at(k));
}

// Panels side by side that share the legend below them; the k-th draws column k + 2 of each method's rows.
Chart method_chart(const char* name, const std::string& title, const std::vector<Series>& methods,
                   std::vector<Panel> panels, int legend_rows) {
    Chart chart{.name = name, .settings = log_axes("0,-0.6"), .title = title, .height = 700};
    const double pitch = 1.0 / static_cast<double>(panels.size());
    for (std::size_t k = 0; k < panels.size(); ++k) {
        const auto place = static_cast<double>(k);
        panels[k].frame = Frame{pitch * place + 0.12, pitch * (place + 1) - 0.015, 0.38, 0.88};
    }
    std::vector<Curve> entries;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const std::string block = chart.add(methods[i].label, methods[i].rows);
        for (std::size_t k = 0; k < panels.size(); ++k) {
            panels[k].curves.push_back({fmt::format("{} using 1:{}", block, k + 2), method_style(i)});
        }
        entries.push_back({"NaN", method_style(i), methods[i].label});
    }
    chart.panels = std::move(panels);
    chart.panels.push_back(legend_below(0.27, legend_rows, std::move(entries)));
    return chart;
}

// A logarithmic axis of whole numbers with room beside the least and the greatest; the ticks are at values that occur.
template <typename Records, typename Value>
Axis number_axis(const char* label, const Records& records, Value value) {
    auto values = distinct(records, value);
    std::sort(values.begin(), values.end());
    std::string ticks;
    double last = 0;
    for (const int one : values) {
        if (one < 1.8 * last) continue;
        last = one;
        ticks += fmt::format("{}'{}' {}", ticks.empty() ? "" : ", ", one, one);
    }
    return {label, range(values.front() / 1.6, values.back() * 1.6), "(" + ticks + ")"};
}

// An axis of errors from zero, drawn as 1e-17, to the largest; what is above 30 has left the frame.
template <typename Records, typename Value>
Axis error_axis(const char* label, const Records& records, Value value) {
    double largest = 0;
    for (const auto& record : records) largest = std::max(largest, drawn(value(record)));
    return {label, range(3e-18, std::min(30.0, 10 * largest)), "add ('0' 1e-17)"};
}

template <typename Record>
std::string march_label(const Record& record) {
    return record.setting.empty() ? record.method : record.method + ", " + record.setting;
}

Chart drift_chart(const std::vector<DriftRecord>& drifts) {
    const auto methods = series_of(drifts, march_label<DriftRecord>, [](const DriftRecord& record) {
        return fmt::format("{} {} {}\n", record.periods, drawn(record.energy_drift), drawn(record.periodicity_defect));
    });
    const Axis periods =
        number_axis("periods marched", drifts, [](const DriftRecord& record) { return record.periods; });
    return method_chart(
        "energy-drift",
        fmt::format("Drift of the first nonsmooth mode, N = {} (what leaves the frame is unstable)",
                    drifts.front().cells),
        methods,
        {{.title = "energy",
          .x = periods,
          .y = error_axis("|E - E_0|/E_0", drifts, [](const DriftRecord& record) { return record.energy_drift; })},
         {.title = "state",
          .x = periods,
          .y = error_axis("periodicity defect (energy norm)", drifts,
                          [](const DriftRecord& record) { return record.periodicity_defect; })}},
        5);
}

Chart march_chart(const std::vector<MarchRecord>& marches) {
    const auto methods = series_of(marches, march_label<MarchRecord>, [](const MarchRecord& record) {
        return fmt::format("{} {} {} {}\n", record.cells, drawn(record.tip_error),
                           std::max(record.contact_error, smallest_contact_error), record.seconds.median);
    });
    const Axis cells =
        number_axis("cells or elements N", marches, [](const MarchRecord& record) { return record.cells; });
    return method_chart(
        "error-and-cost", "One period of the first nonsmooth mode", methods,
        {{.title = "tip displacement",
          .x = cells,
          .y = error_axis("largest error / |d|", marches, [](const MarchRecord& record) { return record.tip_error; })},
         {.title = "duration of contact", .x = cells, .y = {"relative error", "5e-5:5", "add ('0' 1e-4)"}},
         {.title = "cost of a period", .x = cells, .y = {.label = "CPU time (s)"}}},
        5);
}

Chart kernel_chart(const std::vector<KernelRecord>& kernels) {
    const auto methods = series_of(
        kernels, [](const KernelRecord& record) { return record.method; },
        [](const KernelRecord& record) {
            return fmt::format("{} {} {}\n", record.pattern.cells, drawn(record.error), record.seconds.median);
        });
    const Axis cells = number_axis("cells N", kernels, [](const KernelRecord& record) { return record.pattern.cells; });
    return method_chart("accuracy-kernels", "Kernel of S_T: error and cost", methods,
                        {{.title = "distance to the exact space",
                          .x = cells,
                          .y = error_axis("sine of the largest angle", kernels,
                                          [](const KernelRecord& record) { return record.error; })},
                         {.title = "cost", .x = cells, .y = {.label = "CPU time (s)"}}},
                        2);
}

}  // namespace

std::vector<Chart> accuracy_charts(const AccuracyResults& results) {
    std::vector<Chart> charts;
    if (!results.programs.empty()) charts.push_back(program_chart(results.programs));
    if (!results.kernels.empty()) charts.push_back(kernel_chart(results.kernels));
    if (!results.marches.empty()) charts.push_back(march_chart(results.marches));
    if (!results.drifts.empty()) charts.push_back(drift_chart(results.drifts));
    for (Chart& chart : stability_charts(results)) charts.push_back(std::move(chart));
    return charts;
}

}  // namespace nsma
