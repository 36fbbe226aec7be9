#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "accuracy_folder.hpp"
#include "stability_charts.hpp"
#include "report/chart_blocks.hpp"
#include "report/gnuplot.hpp"

namespace nsma {
namespace {

constexpr double smallest = 1e-17;  // what an error of zero is drawn at
constexpr double smallest_contact_error = 1e-4;

template <typename Record, typename Name>
std::vector<std::string> names(const std::vector<Record>& records, Name name_of) {
    std::vector<std::string> seen;
    for (const auto& record : records) {
        const std::string name = name_of(record);
        if (std::find(seen.begin(), seen.end(), name) == seen.end()) seen.push_back(name);
    }
    return seen;
}

std::string frame(double left, double right, double bottom, double top) {
    return fmt::format("set lmargin screen {}\nset rmargin screen {}\nset bmargin screen {}\nset tmargin screen {}\n",
                       left, right, bottom, top);
}

constexpr const char* log_axes =
    "set logscale xy\nset format x '10^{%L}'\nset format y '10^{%L}'\nset xtics out nomirror\nset ytics out nomirror\n"
    "set border 3 lc rgb '#333333'\nset grid xtics ytics lc rgb '#e4e4e4' lt 1\nunset key\n";

// A panel that shows nothing but the legend of the marks drawn elsewhere.
std::string legend(const std::vector<std::pair<std::string, std::string>>& entries, double bottom, double top,
                   int rows) {
    std::string text =
        frame(0.02, 0.98, bottom, top) +
        "unset title\nunset xlabel\nunset ylabel\nunset border\nunset xtics\nunset ytics\nunset grid\n"
        "unset logscale\nset xrange [0:1]\nset yrange [0:1]\n" +
        fmt::format("set key center center vertical maxrows {} Left reverse samplen 2.5 width -2 font ',11'\nplot ",
                    rows);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        text += fmt::format("{}NaN with {} title {}", i == 0 ? "" : ", ", entries[i].second,
                            gnuplot_text(entries[i].first));
    }
    return text + "\n";
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

constexpr const char* any_front = "lines lw 2 dt 3 lc rgb '#888888'";
constexpr const char* certified_front = "lines lw 2.5 dt 1 lc rgb '#bbbbbb'";

Chart program_chart(const AccuracyResults& results) {
    Chart chart{"accuracy-programs", "", log_axes, 1060};
    const auto labels = names(results.programs, program_label);
    std::vector<int> sizes;
    double slowest = 1e-4;
    double fastest = 1e4;
    for (const auto& record : results.programs) {
        if (std::find(sizes.begin(), sizes.end(), record.size) == sizes.end()) sizes.push_back(record.size);
        slowest = std::max(slowest, record.seconds.high);
        fastest = std::min(fastest, std::max(record.seconds.low, 1e-7));
    }
    chart.commands += fmt::format(
        "set multiplot title 'One orbit at a given energy: CPU time against error, by number m of amplitudes' font "
        "',15'\n"
        "set xrange [{}:{}]\nset yrange [2e-16:30]\n",
        fastest / 2, slowest * 2);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const std::string suffix = fmt::format("-{}", sizes[k]);
        add_block(chart, "certified-front" + suffix,
                  stairs(pareto_front(results.programs, sizes[k], true), slowest * 2));
        add_block(chart, "front" + suffix, stairs(pareto_front(results.programs, sizes[k]), slowest * 2));
        const double left = k % 2 == 0 ? 0.10 : 0.59;
        const double top = k < 2 ? 0.93 : 0.55;
        chart.commands += frame(left, left + 0.39, top - 0.30, top);
        chart.commands += fmt::format(
            "set title 'm = {}' offset 0,-0.7\nset xlabel '{}' offset 0,0.5\n"
            "set ylabel 'largest error' offset 1,0\n",
            sizes[k], k + 2 < sizes.size() ? "" : "CPU time of a run (s)");
        std::string plot = fmt::format(
            "plot '{}.dat' index 'certified-front{}' using 1:2 with {}, '' index 'front{}' using 1:2 with {}",
            chart.name, suffix, certified_front, suffix, any_front);
        for (const bool certified : {false, true}) {
            for (auto label = labels.rbegin(); label != labels.rend(); ++label) {  // the first ones on top
                std::string rows;
                for (const auto& record : results.programs) {
                    if (record.size != sizes[k] || program_label(record) != *label ||
                        all_certified(record) != certified)
                        continue;
                    rows += fmt::format("{} {} {} {}\n", record.seconds.median, drawn_error(record), record.seconds.low,
                                        record.seconds.high);
                }
                if (rows.empty()) continue;
                const std::string name = fmt::format("{} {} {}", certified ? "certified" : "any", sizes[k], *label);
                add_block(chart, name, rows);
                plot += fmt::format(
                    ", \\\n    '' index '{}' using 1:2:3:4 with xerrorbars pt 0 lw 1 lc rgb '#999999', "
                    "'' index '{}' using 1:2 with {}",
                    name, name, program_style(*label, certified));
            }
        }
        chart.commands += plot + "\n";
    }
    std::vector<std::pair<std::string, std::string>> entries;
    for (const auto& label : labels) entries.emplace_back(label, program_style(label, true));
    entries.emplace_back("hollow: not every answer certified", program_style("Ipopt", false));
    entries.emplace_back("Pareto front, certified", certified_front);
    entries.emplace_back("Pareto front, any", any_front);
    chart.commands += legend(entries, 0.0, 0.16, 5) + "unset multiplot\n";
    return chart;
}

std::string march_label(const std::string& method, const std::string& setting) {
    return setting.empty() ? method : method + ", " + setting;
}

std::string line_style(std::size_t index) {
    const MethodStyle style = method_style(index);
    return fmt::format("linespoints pt {} dt {} ps 1.1*mark lw 1.6 lc rgb '{}'", style.point, style.dash, style.colour);
}

// Panels side by side that share the legend below them.
struct Panel {
    std::string title, x, y, columns;
    std::string extra;
};
Chart panels_chart(const std::string& name, const std::string& title, const std::vector<std::string>& labels,
                   const std::vector<std::string>& rows, const std::vector<Panel>& panels, int legend_rows) {
    Chart chart{name, "", log_axes, 700};
    chart.commands += fmt::format("set multiplot title {} font ',15'\n", gnuplot_text(title));
    std::vector<std::pair<std::string, std::string>> entries;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        add_block(chart, labels[i], rows[i]);
        entries.emplace_back(labels[i], line_style(i));
    }
    const double pitch = 1.0 / static_cast<double>(panels.size());
    for (std::size_t k = 0; k < panels.size(); ++k) {
        const double left = pitch * static_cast<double>(k) + 0.095;
        chart.commands +=
            frame(left, pitch * static_cast<double>(k + 1) - 0.02, 0.38, 0.88) +
            fmt::format("set title '{}' offset 0,-0.6\nset xlabel '{}'\nset ylabel '{}' offset 1,0\n{}plot ",
                        panels[k].title, panels[k].x, panels[k].y, panels[k].extra);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            chart.commands += fmt::format("{}'{}.dat' index '{}' using {} with {}", i == 0 ? "" : ", \\\n    ", name,
                                          labels[i], panels[k].columns, line_style(i));
        }
        chart.commands += "\nset autoscale\nset ytics autofreq\n";
    }
    chart.commands += legend(entries, 0.0, 0.27, legend_rows) + "unset multiplot\n";
    return chart;
}

double drawn(double error) { return std::max(error, smallest); }

Chart drift_chart(const AccuracyResults& results) {
    const auto label = [](const DriftRecord& record) { return march_label(record.method, record.setting); };
    const auto labels = names(results.drifts, label);
    std::vector<std::string> rows(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        for (const auto& record : results.drifts) {
            if (label(record) != labels[i]) continue;
            rows[i] +=
                fmt::format("{} {} {}\n", record.periods, drawn(record.energy_drift), drawn(record.periodicity_defect));
        }
    }
    const std::string range = "set yrange [3e-18:30]\nset ytics add ('0' 1e-17)\n";
    return panels_chart("energy-drift",
                        fmt::format("Drift of the first nonsmooth mode, N = {} (what leaves the frame is unstable)",
                                    results.drifts.empty() ? 0 : results.drifts.front().cells),
                        labels, rows,
                        {{"energy", "periods marched", "|E - E_0|/E_0", "1:2", range},
                         {"state", "periods marched", "periodicity defect (energy norm)", "1:3", range}},
                        5);
}

Chart march_chart(const AccuracyResults& results) {
    const auto label = [](const MarchRecord& record) { return march_label(record.method, record.setting); };
    const auto labels = names(results.marches, label);
    std::vector<std::string> rows(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        for (const auto& record : results.marches) {
            if (label(record) != labels[i]) continue;
            rows[i] += fmt::format("{} {} {} {}\n", record.cells, drawn(record.tip_error),
                                   std::max(record.contact_error, smallest_contact_error), record.seconds.median);
        }
    }
    const std::string range = "set xrange [3:500]\nset yrange [3e-18:10]\nset ytics add ('0' 1e-17)\n";
    return panels_chart("error-and-cost", "One period of the first nonsmooth mode", labels, rows,
                        {{"tip displacement", "cells or elements N", "largest error / |d|", "1:2", range},
                         {"duration of contact", "cells or elements N", "relative error", "1:3",
                          "set xrange [3:500]\nset yrange [5e-5:5]\nset ytics add ('0' 1e-4)\n"},
                         {"cost of a period", "cells or elements N", "CPU time (s)", "1:4", "set xrange [3:500]\n"}},
                        5);
}

Chart kernel_chart(const AccuracyResults& results) {
    const auto label = [](const KernelRecord& record) { return record.method; };
    const auto labels = names(results.kernels, label);
    std::vector<std::string> rows(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        for (const auto& record : results.kernels) {
            if (label(record) != labels[i]) continue;
            rows[i] += fmt::format("{} {} {}\n", record.pattern.cells, drawn(record.error), record.seconds.median);
        }
    }
    return panels_chart("accuracy-kernels", "Kernel of S_T: error and cost", labels, rows,
                        {{"distance to the exact space", "cells N", "sine of the largest angle", "1:2",
                          "set xrange [3:300]\nset yrange [3e-18:10]\nset ytics add ('0' 1e-17)\n"},
                         {"cost", "cells N", "CPU time (s)", "1:3", "set xrange [3:300]\n"}},
                        2);
}

}  // namespace

std::vector<Chart> accuracy_charts(const AccuracyResults& results) {
    std::vector<Chart> charts;
    if (!results.programs.empty()) charts.push_back(program_chart(results));
    if (!results.kernels.empty()) charts.push_back(kernel_chart(results));
    if (!results.marches.empty()) charts.push_back(march_chart(results));
    if (!results.drifts.empty()) charts.push_back(drift_chart(results));
    for (Chart& chart : stability_charts(results)) charts.push_back(std::move(chart));
    return charts;
}

}  // namespace nsma
