#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbit_panels.hpp"
#include "report/bar_text.hpp"
#include "report/one_line.hpp"

namespace nsma {
namespace {

/// Fields at places (columns) and times (rows) over one period.
struct Fields {
    Eigen::MatrixXd stress;    ///< [Pa]
    Eigen::MatrixXd velocity;  ///< [m/s]
};

Fields wave_fields(const Orbit& orbit) {
    const int cells = orbit.kernel.pattern.cells;
    const double period = orbit.kernel.pattern.period_ratio();
    const Eigen::VectorXd waves =
        orbit.kernel.waves(orbit.beta) * (orbit.bar.displacement_unit() / orbit.mesh().time_step(orbit.bar));
    const auto wave_at = [&](double when) {  // b_n [m/s]; in steps, may exceed the period
        return waves[static_cast<Eigen::Index>(std::floor(when)) % waves.size()];
    };
    // The same resolution in place and time, about 100 000 samples, a whole number of samples a
    // cell where it can be.
    const int wanted = static_cast<int>(std::clamp(std::sqrt(1e5 / period), 20.0, 300.0));
    const int columns = cells < wanted ? cells * ((wanted + cells - 1) / cells) : wanted;
    const int rows = static_cast<int>(std::clamp(std::round(columns * period), 2.0, 1000.0));
    Fields fields{Eigen::MatrixXd(rows, columns), Eigen::MatrixXd(rows, columns)};
    for (int row = 0; row < rows; ++row) {
        const double now = (row + 0.5) * static_cast<double>(waves.size()) / rows;
        for (int column = 0; column < columns; ++column) {
            // Off the middle of a sample, so that no front passes exactly through a sample.
            const double place = (column + 0.25) * cells / columns;
            const double to_wall = wave_at(now + cells - place);
            const double from_wall = wave_at(now + cells + place);
            fields.stress(row, column) = -orbit.bar.impedance() * (to_wall + from_wall);
            fields.velocity(row, column) = to_wall - from_wall;
        }
    }
    return fields;
}

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

Chart space_time_chart(const Scene& scene, const StoredOrbit& stored, const std::string& name) {
    const Bar& bar = stored.orbit.bar;
    const Pattern& pattern = stored.orbit.kernel.pattern;
    const Units units = units_of(bar, pattern.period_ratio(), 0.0);
    const ScaledUnit length = is_unit_bar(bar) ? ScaledUnit{1.0, "L"} : scaled_unit(bar.length, "m");
    const double width = bar.length * length.factor;
    const double step = stored.orbit.mesh().time_step(bar) * units.time.factor;
    const double period = pattern.period_steps() * step;
    const double touch = pattern.free_steps * step;
    const Fields fields = wave_fields(stored.orbit);
    Chart chart{.name = name,
                .data = fmt::format("# {}: rows over one period, columns over the bar\n", scene.title),
                .settings = R"(# negative blue, nothing white, positive orange; in grey only what is negative grows dark
set palette defined (0 '#08306b', 0.25 '#3f88c5', 0.42 '#c6dbef', 0.5 '#ffffff', 0.58 '#fde6c8', 0.75 '#f7b267', 1 '#e8892b')
)",
                .title = fmt::format("{}: {}", shortened(scene.title, 80), orbit_label(stored))};
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
                 "set arrow from graph 1.015, first {} to graph 1.015, first {} nohead lw 6 lc rgb '#000000'\n"
                 "set label 'held end' at graph 0, graph 1.035 left\n"
                 "set label 'wall' at graph 1, graph 1.035 right\n{}",
                 left, symbol, unit.unit, -bound, bound, fmt::format("'{0:.3g}' {0}, 0, '{1:.3g}' {1}", -bound, bound),
                 touch, period,
                 first ? std::string()
                       : fmt::format("set label 'contact' at graph 1.045, first {} left\n"
                                     "set label 'free' at graph 1.045, first {} left textcolor rgb '#555555'\n",
                                     (touch + period) / 2.0, touch / 2.0)),
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
