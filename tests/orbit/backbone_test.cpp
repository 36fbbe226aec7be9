#include "nsma/orbit/backbone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "nsma/orbit/conditions.hpp"
#include "nsma/orbit/replay.hpp"

namespace {

using nsma::mode_of;
using nsma::mode_patterns;
using nsma::Pattern;

TEST(Backbone, EnergyRatiosByHand) {
    EXPECT_EQ(nsma::backbone_energy_ratio(1, 4.0), 1.0);  // grazing: 1/(4 - 3)^2
    EXPECT_EQ(nsma::backbone_energy_ratio(1, 3.5), 4.0);  // the N = 2, (6, 1) orbit
    EXPECT_EQ(nsma::backbone_energy_ratio(1, 2.0), 1.0);  // prestressed, at its linear end
    EXPECT_EQ(nsma::backbone_energy_ratio(2, 1.0), 1.0);  // 1/(4 - 5)^2
    EXPECT_EQ(nsma::backbone_energy_ratio(2, 1.375), 4.0);
    EXPECT_THROW((void)nsma::backbone_energy_ratio(1, 3.0), std::invalid_argument);
    EXPECT_THROW((void)nsma::backbone_energy_ratio(2, 1.25), std::invalid_argument);
    EXPECT_THROW((void)nsma::backbone_energy_ratio(0, 2.0), std::invalid_argument);
    EXPECT_THROW((void)nsma::backbone_energy_ratio(1, -2.0), std::invalid_argument);
    EXPECT_THROW((void)nsma::backbone_energy_ratio(1, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(Backbone, IntervalsByHand) {
    const nsma::PeriodInterval open = nsma::backbone_period_interval(1, 1);
    EXPECT_EQ(open.lo, 3.0);
    EXPECT_EQ(open.hi, 4.0);
    const nsma::PeriodInterval pressed = nsma::backbone_period_interval(2, -1);
    EXPECT_EQ(pressed.lo, 1.0);
    EXPECT_EQ(pressed.hi, 1.25);
    const nsma::PeriodInterval closed = nsma::backbone_period_interval(2, 0);
    EXPECT_EQ(closed.lo, 1.25);
    EXPECT_EQ(closed.hi, 1.25);
    EXPECT_THROW((void)nsma::backbone_period_interval(1, 2), std::invalid_argument);
    EXPECT_THROW((void)nsma::backbone_period_interval(0, 1), std::invalid_argument);
}

TEST(Backbone, PatternsByHand) {
    // N = 2: 2N < n_T < 4N on mode 1; d = 0 at n_T = 3N = 6.
    EXPECT_EQ(mode_patterns(1, 2, 1), (std::vector<Pattern>{{2, 6, 1}}));
    EXPECT_EQ(mode_patterns(1, 2, 0), (std::vector<Pattern>{{2, 4, 2}}));
    EXPECT_EQ(mode_patterns(1, 2, -1), (std::vector<Pattern>{{2, 2, 3}}));
    EXPECT_TRUE(mode_patterns(3, 2, 1).empty());
    // The first mode of the paper's scene, N = 20: n_T = 61..79.
    const std::vector<Pattern> first = mode_patterns(1, 20, 1);
    ASSERT_EQ(first.size(), 19U);
    EXPECT_EQ(first.front(), (Pattern{20, 42, 19}));
    EXPECT_EQ(first.back(), (Pattern{20, 78, 1}));
    // A huge mode number leaves no pattern, and no product overflows.
    EXPECT_TRUE(mode_patterns(2'147'483'647, nsma::max_cells, 1).empty());
    EXPECT_THROW((void)mode_patterns(0, 2, 1), std::invalid_argument);
    EXPECT_THROW((void)mode_patterns(1, 0, 1), std::invalid_argument);
    EXPECT_THROW((void)mode_patterns(1, 2, 3), std::invalid_argument);
}

TEST(Backbone, ModesAndPatternsAreInverse) {
    // Every pattern of a mesh is found in the list of its mode, inside the open interval of T,
    // and in no other list.
    const int cells = 12;
    for (const Pattern& pattern : nsma::patterns_in(cells, {.period_hi = 4 * cells})) {
        int found = 0;
        for (int mode = 1; mode <= 4 * cells; ++mode) {
            for (const int gap_sign : {-1, 0, 1}) {
                const std::vector<Pattern> list = mode_patterns(mode, cells, gap_sign);
                if (std::find(list.begin(), list.end(), pattern) == list.end()) {
                    continue;
                }
                ++found;
                EXPECT_EQ(mode_of(pattern), mode);
                const auto [lo, hi] = nsma::backbone_period_interval(mode, gap_sign);
                const double ratio = pattern.period_ratio();
                if (gap_sign == 0) {
                    EXPECT_NEAR(ratio, lo, 1e-15 * 4.0);  // one division each
                } else {
                    EXPECT_TRUE(lo < ratio && ratio < hi);
                }
            }
        }
        EXPECT_EQ(found, mode_of(pattern).has_value() ? 1 : 0);
    }
    EXPECT_EQ(mode_of({2, 6, 1}), 1);
    EXPECT_EQ(mode_of({2, 5, 1}), std::nullopt);
    EXPECT_EQ(mode_of({6, 16, 4}), 1);
    EXPECT_EQ(mode_of({2, 6, 3}), std::nullopt);
    EXPECT_THROW((void)mode_of({2, 0, 1}), std::invalid_argument);
}

/// The unique orbit of every pattern with m = 1, scaled to touch the wall (COND2), has the energy
/// of the formula and is an orbit of the real contact problem for 1 000 periods.
class BackboneOrbits : public testing::TestWithParam<int> {};

TEST_P(BackboneOrbits, HaveTheExactEnergyAndSurviveTheMarcher) {
    const int mode = GetParam();
    int cases[2] = {0, 0};
    // The intervals of T narrow as 1/k^3: finer meshes for the higher modes.
    const std::vector<int> meshes =
        mode <= 2 ? std::vector<int>{5, 7, 11, 16, 23, 37} : std::vector<int>{17, 23, 29, 37, 43, 53, 59};
    for (const int cells : meshes) {
        for (const int gap_sign : {1, -1}) {
            for (const Pattern& pattern : mode_patterns(mode, cells, gap_sign)) {
                const nsma::Kernel kernel = nsma::exact_kernel(pattern);
                if (kernel.dimension() != 1) {
                    continue;
                }
                nsma::Bar bar;
                bar.gap = gap_sign;
                const double row = nsma::contact_row(kernel)[0];
                ASSERT_NE(row, 0.0);
                const nsma::Orbit orbit = make_orbit(bar, kernel, Eigen::VectorXd::Constant(1, gap_sign / row));
                const double exact = nsma::backbone_energy_ratio(mode, pattern.period_ratio());
                // T/tau is rounded once; the denominator is at least 1/N.
                EXPECT_NEAR(nsma::energy_ratio(orbit) / exact, 1.0, 1e-12);
                const nsma::Replay replay = nsma::replay(orbit, exact, 1000);
                EXPECT_TRUE(replay.accepted) << "N " << cells << ", r " << pattern.free_steps << ", p "
                                             << pattern.contact_steps << ", worst " << replay.violations.worst();
                EXPECT_EQ(replay.march.free_steps, pattern.free_steps);
                EXPECT_EQ(replay.march.contact_steps, pattern.contact_steps);
                EXPECT_EQ(replay.march.contact_phases, 1);
                // One amplitude, only flipped: the same 2N numbers, bit for bit, every period.
                EXPECT_EQ(replay.march.periodicity_defect, 0.0);
                EXPECT_EQ(replay.march.energy_drift, 0.0);
                EXPECT_LT(replay.violations.worst(), 1e-12);
                ++cases[gap_sign > 0];
            }
        }
    }
    EXPECT_GE(cases[0], 5);  // prestressed
    EXPECT_GE(cases[1], 2);  // open gap
    RecordProperty("prestressed_orbits", cases[0]);
    RecordProperty("open_gap_orbits", cases[1]);
}

INSTANTIATE_TEST_SUITE_P(FirstFourModes, BackboneOrbits, testing::Range(1, 5));

}  // namespace
