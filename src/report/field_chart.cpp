#include "field_chart.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bar_text.hpp"
#include "orbit_units.hpp"

namespace nsma {
namespace {

std::string matrix_rows(const Eigen::MatrixXd& field, double factor) {
    std::string text;
    for (Eigen::Index row = 0; row < field.rows(); ++row) {
        for (Eigen::Index column = 0; column < field.cols(); ++column)
            text += fmt::format("{}{:.5g}", column == 0 ? "" : " ", field(row, column) * factor + 0.0);
        text += '\n';
    }
    return text;
}

}  // namespace

Chart field_chart(const Bar& bar, const FieldSamples& fields, const std::string& name, const std::string& scene,
                  const std::string& title) {
    const Units units = units_of(bar, fields.duration / bar.travel_time(), 0.0);
    const ScaledUnit length = is_unit_bar(bar) ? ScaledUnit{1.0, "L"} : scaled_unit(bar.length, "m");
    const double width = bar.length * length.factor;
    const double period = fields.duration * units.time.factor;
    std::string contacts, names;
    for (const auto& [from, to] : fields.contacts) {
        contacts +=
            fmt::format("set arrow from graph 1.015, first {} to graph 1.015, first {} nohead lw 6 lc rgb '#000000'\n",
                        from * units.time.factor, to * units.time.factor);
    }
    if (fields.contacts.size() == 1) {
        const auto [from, to] = fields.contacts.front();
        const double before = from, after = fields.duration - to;
        names = fmt::format(
            "set label 'contact' at graph 1.045, first {} left\n"
            "set label 'free' at graph 1.045, first {} left textcolor rgb '#555555'\n",
            0.5 * (from + to) * units.time.factor,
            (before >= after ? 0.5 * before : 0.5 * (to + fields.duration)) * units.time.factor);
    }
    Chart chart{.name = name,
                .data = fmt::format("# {}: rows over one period, columns over the bar\n", scene),
                .settings = R"(# negative blue, nothing white, positive orange; in grey only what is negative grows dark
set palette defined (0 '#08306b', 0.25 '#3f88c5', 0.42 '#c6dbef', 0.5 '#ffffff', 0.58 '#fde6c8', 0.75 '#f7b267', 1 '#e8892b')
)",
                .title = title};
    const auto add = [&](const char* block, const Eigen::MatrixXd& field, const char* unit_name, const char* symbol,
                         double left, bool first) {
        const double largest = field.cwiseAbs().maxCoeff();
        const ScaledUnit unit = scaled_unit(largest, unit_name);
        const double bound = std::max(largest * unit.factor, 1e-9);
        const std::string source = chart.add(fmt::format("{} [{}]", block, unit.unit), matrix_rows(field, unit.factor));
        chart.panels.push_back(
            {.frame = Frame{left, left + 0.37, 0.27, 0.87},
             .x = {is_unit_bar(bar) ? "position s/L" : fmt::format("position s ({})", length.unit), range(0.0, width)},
             .y = {first ? units.time_label : "", range(0.0, period), first ? "format '%g'" : "format ''"},
             .settings = fmt::format(
                 "set colorbox horizontal user origin screen {}, screen 0.115 size screen 0.37, screen 0.025\n"
                 "set cblabel '{} ({})' offset 0,0.4\nset cbrange [{}:{}]\nset cbtics ({})\nunset arrow\n"
                 "{}"
                 "set label 'held end' at graph 0, graph 1.035 left\n"
                 "set label 'wall' at graph 1, graph 1.035 right\n{}",
                 left, symbol, unit.unit, -bound, bound, fmt::format("'{0:.3g}' {0}, 0, '{1:.3g}' {1}", -bound, bound),
                 contacts, first ? "" : names),
             .curves = {
                 {fmt::format("{} matrix using (($1 + 0.5)*{}):(($2 + 0.5)*{}):3", source,
                              width / static_cast<double>(field.cols()), period / static_cast<double>(field.rows())),
                  "image"}}});
    };
    add("stress", fields.stress, "Pa", "stress σ, tension > 0", 0.09, true);
    add("velocity", fields.velocity, "m/s", "velocity v, to the wall > 0", 0.53, false);
    return chart;
}

}  // namespace nsma
