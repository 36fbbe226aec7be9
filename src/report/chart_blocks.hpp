#pragma once

#include <string>
#include <vector>

#include "charts.hpp"

namespace nsma {

/// Adds a named block of rows to a chart's data file; gnuplot finds it by its name.
void add_block(Chart& chart, const std::string& name, const std::string& rows);

/// How a method is drawn everywhere: marker, dash and shade differ, so that grey print does.
struct MethodStyle {
    int point = 1;
    int dash = 1;
    std::string colour;
};
[[nodiscard]] MethodStyle method_style(std::size_t index);

/// A heat map: one shaded cell with a number for each value.
struct HeatMap {
    std::string name;  ///< of its data block
    std::string title;
    std::string x_label;
    std::vector<std::string> columns;
    std::vector<std::string> rows;  ///< bottom to top
    struct Cell {
        int column = 0;
        int row = 0;
        double shade = 0;  ///< 0 light .. 1 dark
        std::string text;
    };
    std::vector<Cell> cells;
};

/// Adds the data of a heat map and the commands of its panel between screen coordinates.
void add_heat_map(Chart& chart, const HeatMap& map, double left, double right, double bottom, double top);

}  // namespace nsma
