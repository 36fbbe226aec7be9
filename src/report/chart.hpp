#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nsma {

/// Points drawn in one style.
struct Curve {
    std::string source;      ///< in gnuplot's words: "'NAME.dat' index 0 using 1:2"; NaN for an entry of the key alone
    std::string style;       ///< what follows gnuplot's `with`; sizes of marks are multiples of the variable `mark`
    std::string title = {};  ///< in the key; empty: not there
};

struct Axis {
    std::string label = {};
    std::string range = "*:*";  ///< gnuplot's: "0:10"; * is decided by the data
    std::string ticks = {};     ///< options of gnuplot's `set xtics`; empty: as it likes
};

/// "lo:hi", a range of an axis.
[[nodiscard]] std::string range(double lo, double hi);

/// Edges of a panel as fractions of the picture, from the left and from below.
struct Frame {
    double left, right, bottom, top;
};

struct Panel {
    std::optional<Frame> frame = {};  ///< absent: gnuplot's margins
    std::string title = {};
    Axis x = {};
    Axis y = {};
    std::string key = {};       ///< options of gnuplot's `set key`; empty: no key
    std::string settings = {};  ///< further gnuplot commands; labels and objects are forgotten after the panel
    std::vector<Curve> curves = {};
};

/// A chart: its data and what is drawn of them.
struct Chart {
    std::string name;
    std::string data = {};      ///< the text of NAME.dat
    std::string settings = {};  ///< gnuplot commands ahead of all panels
    std::string title = {};     ///< above all panels
    std::vector<Panel> panels = {};
    int height = 625;  ///< for a width of 1000
    int blocks = 0;    ///< of rows in the data

    /// Adds a block of rows to the data; returns it as the source of a curve, without the columns. A block without rows
    /// draws nothing.
    [[nodiscard]] std::string add(const std::string& block, const std::string& rows);
};

/// The last panel of several: a key to what the others draw, between invisible axes.
[[nodiscard]] Panel legend(const Frame& frame, const std::string& key, std::vector<Curve> entries);

/// Styles that stay apart in grey print: the mark, and dash and shade of the line.
struct CurveStyle {
    int mark;
    const char* line;
};
inline constexpr std::array<CurveStyle, 6> curve_styles{{{7, "dt 1 lc rgb '#000000'"},
                                                         {5, "dt 2 lc rgb '#0072b2'"},
                                                         {9, "dt 4 lc rgb '#d55e00'"},
                                                         {6, "dt 1 lc rgb '#777777'"},
                                                         {4, "dt 2 lc rgb '#56b4e9'"},
                                                         {8, "dt 4 lc rgb '#999999'"}}};
/// "linespoints ..." in that style.
[[nodiscard]] std::string marked_line(const CurveStyle& style, double size);

/// Panel settings that fill everything above x = `position` and write `words` at the height `label`.
[[nodiscard]] std::string wall(double position, double label, const char* words);

/// A gnuplot string in single quotes.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

/// The unit with the SI prefix that brings `largest` into 1..1000, and the factor that turns
/// base units into it: 2.1e9, "Pa" -> {1e-9, "GPa"}.
struct ScaledUnit {
    double factor = 1.0;
    std::string unit;
};
[[nodiscard]] ScaledUnit scaled_unit(double largest, const std::string& unit);

/// The values of the records, each once, in the order they come: e.g. the methods of a key.
template <typename Records, typename Value>
[[nodiscard]] auto distinct(const Records& records, Value value) {
    std::vector<std::decay_t<decltype(value(*records.begin()))>> values;
    for (const auto& record : records) {
        const auto& one = value(record);
        if (std::find(values.begin(), values.end(), one) == values.end()) values.push_back(one);
    }
    return values;
}

/// The largest of 1, 2 and 5 times a power of ten that does not exceed `limit` > 0.
[[nodiscard]] double round_below(double limit);

/// Formats and size of the pictures.
struct Drawing {
    std::vector<std::string> formats{"svg", "png"};  ///< of picture_formats
    std::optional<int> width = {};                   ///< pixels, of a PDF points; absent: 1000, of a PNG 1600
    std::optional<int> height = {};                  ///< absent: in the chart's own proportion
};
inline constexpr std::array<const char*, 3> picture_formats{"svg", "png", "pdf"};

/// The gnuplot script that draws a chart.
[[nodiscard]] std::string gnuplot_script(const Chart& chart, const Drawing& drawing = {});

/// Writes NAME.dat and NAME.gp of every chart into `folder` (made if missing), then runs gnuplot on each, which leaves
/// NAME.svg and so on; `gnuplot NAME.gp` in that folder draws it again. Returns the pictures. Throws InputError (one
/// line) when the folder cannot be written or gnuplot fails, NoGnuplot when there is none.
[[nodiscard]] std::vector<std::filesystem::path> draw_charts(const std::vector<Chart>& charts,
                                                             const std::filesystem::path& folder,
                                                             const Drawing& drawing = {});

}  // namespace nsma
