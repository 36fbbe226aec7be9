#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "chart_blocks.hpp"
#include "gnuplot.hpp"
#include "nsma/report/accuracy_folder.hpp"
#include "stability_charts.hpp"

namespace nsma {
namespace {

constexpr double smallest = 1e-17;  // what an error of zero is drawn at

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
std::string legend(const std::vector<std::pair<std::string, std::string>>& entries, double bottom, double top, int rows) {
    std::string text = frame(0.02, 0.98, bottom, top) +
                       "unset title\nunset xlabel\nunset ylabel\nunset border\nunset xtics\nunset ytics\nunset grid\n"
                       "unset logscale\nset xrange [0:1]\nset yrange [0:1]\n" +
                       fmt::format("set key center center vertical maxrows {} Left reverse samplen 2.5 width -2 font ',11'\nplot ", rows);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        text += fmt::format("{}NaN with {} title {}", i == 0 ? "" : ", ", entries[i].second, gnuplot_text(entries[i].first));
    }
    return text + "\n";
}

// Answers as they are, and polished ones, of one method.
std::string program_label(const ProgramRecord& record) {
    if (record.setting.find("tol") == std::string::npos) return record.method;
    std::string kind = record.setting.find("polish") != std::string::npos ? "polished" : "raw";
    if (record.setting.find("warm") != std::string::npos) kind += ", warm";
    return record.method + ", " + kind;
}

std::string program_style(const std::string& label) {
    const bool polished = label.find("polished") != std::string::npos;
    const bool warm = label.find("warm") != std::string::npos;
    if (label == "default") return "points pt 3 ps 2.2*mark lw 2.5 lc rgb '#000000'";
    if (label == "proof first") return "points pt 1 ps 2.0*mark lw 2.5 lc rgb '#000000'";
    if (label == "segment") return "points pt 2 ps 1.6*mark lw 2.5 lc rgb '#d55e00'";
    const auto point = [&](int hollow, const char* colour) {
        return fmt::format("points pt {} ps {}*mark lw 1.6 lc rgb '{}'", polished ? hollow + 1 : hollow, warm ? 0.8 : 1.3, colour);
    };
    if (label.rfind("Ipopt lifted", 0) == 0) return point(14, "#0072b2");
    if (label.rfind("Ipopt", 0) == 0) return point(6, warm ? "#56b4e9" : "#0072b2");
    if (label.rfind("SLSQP", 0) == 0) return point(8, "#b8500a");
    if (label.rfind("AUGLAG+LBFGS", 0) == 0) return point(4, "#009e73");
    if (label.rfind("AUGLAG+SLSQP", 0) == 0) return point(12, "#7a5195");
    if (label.rfind("COBYLA", 0) == 0) return point(10, "#777777");
    return polished ? "points pt 16 ps 1.3*mark lc rgb '#aaaaaa'" : "points pt 1 ps 1.3*mark lw 1.6 lc rgb '#aaaaaa'";
}

Chart program_chart(const AccuracyResults& results) {
    Chart chart{"accuracy-programs", "", log_axes, 1000};
    const auto labels = names(results.programs, program_label);
    std::vector<int> sizes;
    double slowest = 1e-4;
    double fastest = 1e4;
    for (const auto& record : results.programs) {
        if (std::find(sizes.begin(), sizes.end(), record.size) == sizes.end()) sizes.push_back(record.size);
        slowest = std::max(slowest, record.seconds.high);
        fastest = std::min(fastest, std::max(record.seconds.low, 1e-7));
    }
    chart.commands += fmt::format("set multiplot title {} font ',15'\nset xrange [{}:{}]\nset yrange [2e-16:30]\n",
                                  gnuplot_text("Programs: CPU time against error, one panel a size; the line joins what nothing beats"),
                                  fastest / 2, slowest * 2);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        std::string front;
        const auto best = pareto_front(results.programs, sizes[k]);
        const auto error = [](const ProgramRecord& record) { return std::clamp(record.error, 1e-15, 10.0); };
        double least = 30;  // the lower envelope of the front's medians
        for (const auto* record : best) {
            if (error(*record) >= least) continue;
            front += fmt::format("{} {}\n{} {}\n", record->seconds.median, least, record->seconds.median, error(*record));
            least = error(*record);
        }
        if (!best.empty()) front += fmt::format("{} {}\n", slowest * 2, least);
        const std::string front_name = fmt::format("front-{}", sizes[k]);
        add_block(chart, front_name, front);
        const double left = k % 2 == 0 ? 0.10 : 0.58;
        const double top = k < 2 ? 0.92 : 0.57;
        chart.commands += frame(left, left + 0.39, top - 0.27, top);
        chart.commands += fmt::format("set title 'm = {}' offset 0,-0.7\nset xlabel 'CPU time of a run (s)' offset 0,0.4\n"
                                      "set ylabel 'largest error' offset 1,0\n", sizes[k]);
        std::string plot = fmt::format("plot '{}.dat' index '{}' using 1:2 with lines lw 2 dt 2 lc rgb '#999999'", chart.name, front_name);
        for (const auto& label : labels) {
            std::string rows, bars;
            for (const auto& record : results.programs) {
                if (record.size != sizes[k] || program_label(record) != label) continue;
                rows += fmt::format("{} {} {} {}\n", record.seconds.median, error(record), record.seconds.low, record.seconds.high);
            }
            if (rows.empty()) continue;
            const std::string name = fmt::format("{} {}", sizes[k], label);
            add_block(chart, name, rows);
            plot += fmt::format(", \\\n    '' index '{}' using 1:2:3:4 with xerrorbars pt 0 lw 1 lc rgb '#bbbbbb', "
                                "'' index '{}' using 1:2 with {}", name, name, program_style(label));
        }
        chart.commands += plot + "\n";
    }
    std::vector<std::pair<std::string, std::string>> entries{{"Pareto front", "lines lw 2 dt 2 lc rgb '#999999'"}};
    for (const auto& label : labels) entries.emplace_back(label, program_style(label));
    chart.commands += legend(entries, 0.0, 0.19, 6) + "unset multiplot\n";
    return chart;
}

std::string march_label(const std::string& method, const std::string& setting) {
    return setting.empty() ? method : method + ", " + setting;
}

std::string line_style(std::size_t index) {
    const MethodStyle style = method_style(index);
    return fmt::format("linespoints pt {} dt {} ps 1.1*mark lw 1.6 lc rgb '{}'", style.point, style.dash, style.colour);
}

// Two panels that share the legend below them.
struct Panel {
    std::string title, x, y, columns;
    std::string extra;
};
Chart two_panels(const std::string& name, const std::string& title, const std::vector<std::string>& labels,
                 const std::vector<std::string>& rows, const std::array<Panel, 2>& panels, int legend_rows) {
    Chart chart{name, "", log_axes, 700};
    chart.commands += fmt::format("set multiplot title {} font ',15'\n", gnuplot_text(title));
    std::vector<std::pair<std::string, std::string>> entries;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        add_block(chart, labels[i], rows[i]);
        entries.emplace_back(labels[i], line_style(i));
    }
    for (std::size_t k = 0; k < panels.size(); ++k) {
        const double left = k == 0 ? 0.10 : 0.60;
        chart.commands += frame(left, left + 0.38, 0.38, 0.88) +
                          fmt::format("set title '{}' offset 0,-0.6\nset xlabel '{}'\nset ylabel '{}' offset 1,0\n{}plot ", panels[k].title,
                                      panels[k].x, panels[k].y, panels[k].extra);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            chart.commands += fmt::format("{}'{}.dat' index '{}' using {} with {}", i == 0 ? "" : ", \\\n    ", name, labels[i],
                                          panels[k].columns, line_style(i));
        }
        chart.commands += "\nset autoscale\n";
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
            rows[i] += fmt::format("{} {} {}\n", record.periods, drawn(record.energy_drift), drawn(record.periodicity_defect));
        }
    }
    const std::string range = "set yrange [3e-18:30]\nset ytics add ('0' 1e-17)\n";
    return two_panels("energy-drift",
                      fmt::format("Drift of the first nonsmooth mode, N = {}", results.drifts.empty() ? 0 : results.drifts.front().cells),
                      labels, rows,
                      {{{"energy", "periods marched", "|E - E_0|/E_0", "1:2", range},
                        {"state", "periods marched", "periodicity defect (energy norm)", "1:3", range}}},
                      5);
}

Chart march_chart(const AccuracyResults& results) {
    const auto label = [](const MarchRecord& record) { return march_label(record.method, record.setting); };
    const auto labels = names(results.marches, label);
    std::vector<std::string> rows(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        for (const auto& record : results.marches) {
            if (label(record) != labels[i]) continue;
            rows[i] += fmt::format("{} {} {}\n", record.cells, drawn(record.tip_error), record.seconds.median);
        }
    }
    return two_panels("error-and-cost", "One period of the first nonsmooth mode", labels, rows,
                      {{{"error of the tip displacement", "cells or elements N", "largest error / |d|", "1:2",
                         "set yrange [3e-18:10]\nset ytics add ('0' 1e-17)\n"},
                        {"cost of a period", "cells or elements N", "CPU time (s)", "1:3", ""}}},
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
    return two_panels("accuracy-kernels", "Kernel of S_T: error and cost", labels, rows,
                      {{{"distance to the exact space", "cells N", "sine of the largest angle", "1:2", "set yrange [1e-17:1]\n"},
                        {"cost", "cells N", "CPU time (s)", "1:3", ""}}},
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
