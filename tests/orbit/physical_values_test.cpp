#include "nsma/orbit/physical_values.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "nsma/wave/marcher.hpp"
#include "nsma/orbit/conditions.hpp"

namespace nsma {
namespace {

/// Aluminium, 0.5 m long, a tenth of a millimetre from the wall.
Bar rod(double gap = 1e-4) { return {0.5, 70e9, 2700.0, 7.854e-5, gap}; }

/// The least-energy orbit: the shortest beta with x_0 = d.
Orbit least_energy_orbit(const Bar& bar, const Pattern& pattern) {
    const Kernel kernel = exact_kernel(pattern);
    const Eigen::VectorXd row = contact_row(kernel).cast<double>();
    return make_orbit(bar, kernel, bar.gap_sign() * row / row.squaredNorm());
}

const std::vector<Pattern> patterns{{6, 16, 4}, {20, 60, 10}, {20, 48, 16}, {6, 23, 1}, {5, 14, 3}};

TEST(PhysicalValues, AreWhatAMarchMeasures) {
    for (const Pattern& pattern : patterns) {
        SCOPED_TRACE(testing::Message() << pattern.free_steps << ", " << pattern.contact_steps);
        const Orbit orbit = least_energy_orbit(rod(), pattern);
        const PhysicalValues values = physical_values(orbit);
        const double step = orbit.mesh().time_step(orbit.bar);
        EXPECT_NEAR(values.frequency * pattern.period_steps() * step, 1.0, 1e-14);
        const MarchReport march = nsma::march(orbit.bar, orbit.mesh(), initial_state(orbit), pattern.period_steps(), 1);
        double least = orbit.bar.gap, speed = 0, before = orbit.bar.gap;
        for (std::size_t n = 0; n < march.first_period.size(); ++n) {
            least = std::min(least, march.first_period[n].tip);
        }
        // The speed with which the tip arrived: over the last step in which it moved.
        const Eigen::VectorXd tips = tip_displacement(orbit);
        for (int n = 0; n <= pattern.free_steps; ++n) {
            if (n > 0 && std::abs(tips[n] - before) > 1e-12 * orbit.bar.gap) speed = std::abs(tips[n] - before) / step;
            before = tips[n];
        }
        EXPECT_NEAR(values.peak_force, march.largest_force, 1e-9 * (march.largest_force + 1));
        EXPECT_NEAR(values.tip_least, least, 1e-12 * orbit.bar.gap);
        EXPECT_NEAR(values.impact_speed, speed, 1e-9 * speed);
    }
}

TEST(PhysicalValues, StressIsThatOfTheFieldAndTheEnds) {
    for (const Pattern& pattern : patterns) {
        for (const double gap : {1e-4, -1e-4}) {
            const Orbit orbit = least_energy_orbit(rod(gap), pattern);
            const PhysicalValues values = physical_values(orbit);
            // No cell has more at any step; the held end has the spring force of its first cell's waves: sampled a
            // quarter of a cell from it and a quarter of a step after each step, both waves there are the same one.
            const double in_cells = field(orbit).stress.cwiseAbs().maxCoeff();
            EXPECT_LE(in_cells, values.peak_stress * (1 + 1e-12));
            const Eigen::VectorXd waves = orbit.kernel.waves(amplitudes(orbit));
            double at_fixed_end = 0;
            const int cells = pattern.cells;
            for (int n = 0; n < pattern.period_steps(); ++n) {
                const double when = n + 0.5, place = 0.25;
                const auto wave = [&](double at) {
                    return waves[static_cast<Eigen::Index>(std::floor(at)) % waves.size()];
                };
                at_fixed_end = std::max(at_fixed_end, std::abs(orbit.bar.impedance() * (wave(when + cells - place) +
                                                                                        wave(when + cells + place))));
            }
            EXPECT_NEAR(values.peak_stress, at_fixed_end, 1e-9 * at_fixed_end);
        }
    }
}

TEST(PhysicalValues, ScaleWithTheGap) {
    const PhysicalValues one = physical_values(least_energy_orbit(rod(1e-4), {20, 60, 10}));
    const PhysicalValues two = physical_values(least_energy_orbit(rod(2e-4), {20, 60, 10}));
    EXPECT_DOUBLE_EQ(two.frequency, one.frequency);
    for (const auto value : {&PhysicalValues::peak_force, &PhysicalValues::impact_speed, &PhysicalValues::peak_stress,
                             &PhysicalValues::tip_least})
        EXPECT_NEAR(two.*value / (one.*value), 2.0, 1e-12);
}

}  // namespace
}  // namespace nsma
