#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbit_panels.hpp"
#include "report/field_chart.hpp"
#include "report/one_line.hpp"

namespace nsma {
namespace {

FieldSamples wave_fields(const Orbit& orbit) {
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
    const double step = orbit.mesh().time_step(orbit.bar);
    const Pattern& pattern = orbit.kernel.pattern;
    FieldSamples fields{Eigen::MatrixXd(rows, columns),
                        Eigen::MatrixXd(rows, columns),
                        pattern.period_steps() * step,
                        {{pattern.free_steps * step, pattern.period_steps() * step}}};
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

}  // namespace

Chart space_time_chart(const Scene& scene, const StoredOrbit& stored, const std::string& name) {
    return field_chart(stored.orbit.bar, wave_fields(stored.orbit), name, scene.title,
                       fmt::format("{}: {}", shortened(scene.title, 80), orbit_label(stored)));
}

}  // namespace nsma
