#include "chart.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "one_line.hpp"

namespace nsma {
namespace {

// What all charts have in common; names of scenes may hold what gnuplot would take for mark-up.
constexpr const char* script_head = R"(# Drawn by nsma; draw again with: gnuplot {name}.gp
set encoding utf8
do for [format in "{formats}"] {{
if (format eq "svg") {{
    set terminal svg size {svg} font 'sans-serif,14' fontscale {s} linewidth {s} enhanced background rgb 'white'
    mark = 0.65*{s}
}}
if (format eq "png") {{
    set terminal pngcairo size {png} font 'sans-serif,14' fontscale {p} linewidth {p} pointscale {p} enhanced
    mark = 1.0
}}
if (format eq "pdf") {{
    set terminal pdfcairo size {pdf} font 'sans-serif,14' fontscale {d} linewidth {pen} pointscale {d} enhanced
    mark = 1.0
}}
set output '{name}.'.format
reset
set border 3 linecolor rgb '#333333'
set xtics out nomirror
set ytics out nomirror
set title noenhanced
)";

// A title in letters that are small enough for the width of the picture.
std::string title_text(const std::string& title, double usual_size) {
    constexpr std::size_t most = 150;
    constexpr double fit = 85;  // letters of the usual size
    const std::string text = shortened(title, most);
    const double size = usual_size * std::min(1.0, fit / static_cast<double>(std::max<std::size_t>(text.size(), 1)));
    return fmt::format("{} font ',{:.3g}'", gnuplot_text(text), size);
}

std::string axis_commands(char name, const Axis& axis) {
    return fmt::format("set {0}label {1}\nset {0}range [{2}]\nset {0}tics autofreq\n{3}", name,
                       gnuplot_text(axis.label), axis.range,
                       axis.ticks.empty() ? "" : fmt::format("set {}tics {}\n", name, axis.ticks));
}

std::string panel_commands(const Panel& panel) {
    std::string text;
    if (panel.frame) {
        text +=
            fmt::format("set lmargin screen {}\nset rmargin screen {}\nset bmargin screen {}\nset tmargin screen {}\n",
                        panel.frame->left, panel.frame->right, panel.frame->bottom, panel.frame->top);
    }
    text += fmt::format("set title {}\n", title_text(panel.title, 14)) + axis_commands('x', panel.x) +
            axis_commands('y', panel.y) +
            (panel.key.empty() ? "unset key\n" : fmt::format("set key Left reverse {}\n", panel.key)) +
            "unset object\nunset label\n" + panel.settings;
    const char* separator = "plot ";
    for (const Curve& curve : panel.curves) {
        text += fmt::format("{}{} with {} {}", separator, curve.source, curve.style,
                            curve.title.empty() ? "notitle" : "title " + gnuplot_text(curve.title));
        separator = ", \\\n     ";
    }
    return text + (panel.curves.empty() ? "plot NaN notitle\n" : "\n");
}

}  // namespace

std::string Chart::add(const std::string& block, const std::string& rows) {
    data += fmt::format("{}# {}\n{}", data.empty() ? "" : "\n\n", block, rows.empty() ? "NaN NaN NaN NaN\n" : rows);
    return fmt::format("'{}.dat' index {}", name, blocks++);
}

std::string range(double lo, double hi) { return fmt::format("{}:{}", lo, hi); }

Panel legend(const Frame& frame, const std::string& key, std::vector<Curve> entries) {
    return {.frame = frame,
            .x = {.range = "0:1"},
            .y = {.range = "0:1"},
            .key = key,
            .settings = "unset border\nunset tics\nunset grid\nunset logscale\n",
            .curves = std::move(entries)};
}

std::string marked_line(const CurveStyle& style, double size) {
    return fmt::format("linespoints lw 2 pt {} ps {}*mark {}", style.mark, size, style.line);
}

std::string wall(double position, double label, const char* words) {
    return fmt::format(
        "set object rectangle from graph 0, first {} to graph 1, graph 1 behind fillcolor rgb '#dddddd' fillstyle "
        "solid noborder\nset label '{}' at graph 0.5, first {} center textcolor rgb '#333333'\n",
        position, words, label);
}

std::string gnuplot_text(std::string_view text) {
    std::string quoted = "'";
    for (const char letter : one_line(std::string(text))) {
        quoted += letter;
        if (letter == '\'') quoted += letter;
    }
    return quoted + "'";
}

ScaledUnit scaled_unit(double largest, const std::string& unit) {
    static constexpr std::array<const char*, 9> prefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
    if (!std::isfinite(largest) || !(largest > 0.0)) return {1.0, unit};
    const int step = std::clamp(static_cast<int>(std::floor(std::log10(largest) / 3.0 + 1e-9)), -4, 4);
    // Between 0.1 and 1 the plain unit reads better than thousandths of it.
    const int kept = step == -1 && largest >= 0.1 ? 0 : step;
    return {std::pow(10.0, -3 * kept), prefixes.begin()[kept + 4] + unit};
}

double round_below(double limit) {
    const double power = std::pow(10.0, std::floor(std::log10(limit)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * power <= limit) return factor * power;
    }
    return power;
}

std::string gnuplot_script(const Chart& chart, const Drawing& drawing) {
    constexpr double drawn_width = 1000;  // what sizes of letters, lines and marks are meant for
    constexpr int usual_png = 1600;
    constexpr double points_an_inch = 72;
    const double fits = drawing.height ? *drawing.height / static_cast<double>(chart.height) : 1e9;
    const auto scale = [&](int usual) { return drawing.width.value_or(usual) / drawn_width; };
    const auto size = [&](double factor, double unit, const char* word) {
        const double height = drawing.height ? *drawing.height : std::round(chart.height * factor);
        return fmt::format("{0}{2},{1}{2}", factor * drawn_width / unit, height / unit, word);
    };
    const double svg = scale(static_cast<int>(drawn_width));
    const double png = scale(usual_png);
    const double letters = std::min(svg, fits);  // of a flat picture the height decides
    const double png_letters = std::min(png, fits);
    std::string text = fmt::format(
        fmt::runtime(script_head), fmt::arg("name", chart.name), fmt::arg("formats", fmt::join(drawing.formats, " ")),
        fmt::arg("svg", size(svg, 1, "")), fmt::arg("s", letters), fmt::arg("png", size(png, 1, "")),
        fmt::arg("p", png_letters), fmt::arg("pdf", size(svg, points_an_inch, "in")), fmt::arg("d", letters),
        fmt::arg("pen", 2 * letters));
    text += chart.settings;
    const bool several = chart.panels.size() > 1 || !chart.title.empty();
    if (several) text += "set multiplot";
    if (!chart.title.empty()) text += " title " + title_text(chart.title, 15) + " noenhanced";
    if (several) text += "\n";
    for (const Panel& panel : chart.panels) text += panel_commands(panel);
    return text + (several ? "unset multiplot\n" : "") + "unset output\n}\n";
}

}  // namespace nsma
