#include "set/level_points.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace {

using Eigen::VectorXd;
using nsma::admissible_set;
using nsma::AdmissibleSet;
using nsma::conditions;
using nsma::exact_kernel;
using nsma::LevelPoints;
using nsma::Pattern;
using nsma::reduce;

AdmissibleSet set_of(const Pattern& pattern, int gap_sign) {
    return admissible_set(reduce(conditions(exact_kernel(pattern), gap_sign)));
}

/// Literal COND1-3 of a reduced point, to the rounding of sums of its waves.
void expect_admissible(const Pattern& pattern, const AdmissibleSet& set, const VectorXd& gamma) {
    const auto kernel = exact_kernel(pattern);
    const VectorXd beta = set.reduction.beta(gamma);
    const VectorXd tip = nsma::tip_history(kernel, beta);
    const double rounding = 1e-13 * (1 + gamma.lpNorm<1>()) * pattern.cells;
    EXPECT_LE(tip.maxCoeff(), set.reduction.gap_sign + rounding);
    EXPECT_NEAR(tip[0], set.reduction.gap_sign, rounding);
    for (int n = pattern.free_steps; n < pattern.period_steps(); ++n) {
        const int column = kernel.column(n);
        if (column < 0) continue;
        EXPECT_GE(kernel.sign[static_cast<std::size_t>(n)] * beta[column], -rounding);
    }
}

/// Patterns with room for a level, bounded and not, for both signs of the gap.
std::vector<std::pair<Pattern, int>> roomy() {
    std::vector<std::pair<Pattern, int>> result{{{20, 48, 16}, 1}};
    for (const int cells : {4, 6}) {
        for (int period = 2; period <= 4 * cells; ++period) {
            for (int contact = 1; contact < period; ++contact) {
                for (const int gap_sign : {-1, 1}) {
                    const Pattern pattern{cells, period - contact, contact};
                    const auto set = set_of(pattern, gap_sign);
                    if (set.status != AdmissibleSet::Status::nonempty) continue;
                    const auto interval = set.interval();
                    if (interval.unbounded || *interval.greatest > *interval.least * 1.01) {
                        result.emplace_back(pattern, gap_sign);
                    }
                }
            }
        }
    }
    return result;
}

TEST(LevelPoints, StartsAreAdmissibleAndOnTheLevel) {
    const auto patterns = roomy();
    ASSERT_GT(patterns.size(), 10U);
    for (const auto& [pattern, gap_sign] : patterns) {
        const auto set = set_of(pattern, gap_sign);
        const auto interval = set.interval();
        const double top = interval.greatest.value_or(50 * *interval.least);
        for (const double share : {0.001, 0.3, 0.9, 1.0}) {
            const double level = *interval.least + share * (top - *interval.least);
            const LevelPoints points(set, level);
            for (int k = 0; k <= 10; ++k) {
                const auto start = points.start(k);
                ASSERT_TRUE(start) << "N = " << pattern.cells << " (" << pattern.free_steps << ", "
                                   << pattern.contact_steps << ") gap " << gap_sign << " share " << share;
                // |gamma|^2 near a cancelling root: a few units in the last place.
                EXPECT_NEAR(set.energy(*start), level, 1e-14 * level * 8);
                expect_admissible(pattern, set, *start);
            }
            // Off in every way: beyond the bounds, the rows and COND2.
            const VectorXd off = *points.start(10) + VectorXd::Random(set.least.size()) * set.least.norm();
            expect_admissible(pattern, set, points.admissible_near(off));
            const auto restored = points.restored(off);
            ASSERT_TRUE(restored);
            EXPECT_NEAR(set.energy(*restored), level, 1e-14 * level * 8);
            expect_admissible(pattern, set, *restored);
        }
    }
}

TEST(LevelPoints, RandomStartsDifferAndRepeat) {
    const auto set = set_of({20, 48, 16}, 1);
    const LevelPoints points(set, 1.5 * *set.interval().least);
    for (int k = 2; k < 6; ++k) {
        EXPECT_EQ(*points.start(k), *points.start(k));
        EXPECT_GT((*points.start(k) - *points.start(k + 1)).norm(), 1e-3 * points.start(k)->norm());
    }
    EXPECT_GT((*points.start(0) - *points.start(1)).norm(), 1e-3 * points.start(0)->norm());
}

TEST(LevelPoints, ReachGoesUpAndDownFromAnyPoint) {
    const auto set = set_of({6, 16, 4}, 1);  // [9, 36]
    const LevelPoints points(set, 20);
    for (const auto& from : {set.least, set.vertices.front(), VectorXd((set.least + set.vertices.front()) / 2)}) {
        const auto reached = points.reach(from);
        ASSERT_TRUE(reached);
        EXPECT_NEAR(set.energy(*reached), 20, 1e-13);
        expect_admissible({6, 16, 4}, set, *reached);
    }
}

TEST(LevelPoints, LevelOutsideTheIntervalGivesNothing) {
    const auto set = set_of({6, 16, 4}, 1);  // [9, 36]
    for (const double level : {1.0, 8.9, 36.1, 1e6}) {
        const LevelPoints points(set, level);
        for (int k = 0; k <= 5; ++k) EXPECT_FALSE(points.start(k)) << level << " " << k;
    }
}

TEST(LevelPoints, ClosedGapScalesItsDirections) {
    // Mode 1 at its limit period T = 3 tau: N = 4, (8, 4).
    const Pattern pattern{4, 8, 4};
    const auto set = set_of(pattern, 0);
    ASSERT_EQ(set.status, AdmissibleSet::Status::nonempty);
    for (const double level : {1e-6, 1.0, 1e6}) {
        const LevelPoints points(set, level);
        for (int k = 0; k <= 5; ++k) {
            const auto start = points.start(k);
            ASSERT_TRUE(start);
            EXPECT_NEAR(set.energy(*start), level, 1e-14 * level * 8);
            expect_admissible(pattern, set, *start);
        }
    }
}

TEST(LevelPoints, RefusesAnEmptySetOrALevelThatIsNone) {
    const auto empty = set_of({6, 16, 4}, -1);
    EXPECT_THROW(LevelPoints(empty, 10.0), std::invalid_argument);
    const auto set = set_of({6, 16, 4}, 1);
    EXPECT_THROW(LevelPoints(set, 0.0), std::invalid_argument);
    EXPECT_THROW(LevelPoints(set, -1.0), std::invalid_argument);
    EXPECT_THROW(LevelPoints(set, std::nan("")), std::invalid_argument);
}

}  // namespace
