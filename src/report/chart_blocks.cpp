#include "chart_blocks.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "gnuplot.hpp"

namespace nsma {

void add_block(Chart& chart, const std::string& name, const std::string& rows) {
    chart.data += fmt::format("{}# {}\n{}", chart.data.empty() ? "" : "\n\n", name, rows);
}

MethodStyle method_style(std::size_t index) {
    static constexpr std::array<int, 10> points{7, 5, 9, 11, 13, 6, 4, 8, 10, 12};
    static constexpr std::array<const char*, 10> colours{"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                         "#56b4e9", "#e69f00", "#444444", "#7a5195", "#8c564b"};
    const std::size_t k = index % points.size();
    return {points.at(k), static_cast<int>(1 + index % 5), colours.at(k)};
}

void add_heat_map(Chart& chart, const HeatMap& map, double left, double right, double bottom, double top) {
    std::string rows;
    for (const auto& cell : map.cells) {
        rows += fmt::format("{} {} {:.4f} \"{}\" {}\n", cell.column, cell.row, cell.shade, cell.text,
                            cell.shade > 0.55 ? 0xffffff : 0x000000);
    }
    add_block(chart, map.name, rows);
    std::string x_ticks, y_ticks;
    for (std::size_t i = 0; i < map.columns.size(); ++i) {
        x_ticks += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_text(map.columns[i]), i);
    }
    for (std::size_t i = 0; i < map.rows.size(); ++i) {
        y_ticks += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_text(map.rows[i]), i);
    }
    chart.commands += fmt::format(
        "set lmargin screen {}\nset rmargin screen {}\nset bmargin screen {}\nset tmargin screen {}\n"
        "set title {} noenhanced offset 0,-0.6\nset xlabel {} noenhanced\n"
        "set xrange [-0.5:{}]\nset yrange [-0.5:{}]\n"
        "set xtics ({}) scale 0 noenhanced rotate by 40 right font ',10'\nset ytics ({}) scale 0 noenhanced font "
        "',11'\n"
        "plot '{}.dat' index '{}' using 1:2:(0.5):(0.5):3 with boxxy fs solid border lc rgb '#999999' fc palette "
        "notitle, \\\n"
        "    '' index '{}' using 1:2:4:5 with labels tc rgb variable font ',9' notitle\n",
        left, right, bottom, top, gnuplot_text(map.title), gnuplot_text(map.x_label),
        static_cast<double>(map.columns.size()) - 0.5, static_cast<double>(map.rows.size()) - 0.5, x_ticks, y_ticks,
        chart.name, map.name, map.name);
}

}  // namespace nsma
