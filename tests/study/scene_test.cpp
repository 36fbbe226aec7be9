#include "nsma/study/scene.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

namespace {

using nsma::ListSelection;
using nsma::ModeSelection;
using nsma::Pattern;
using nsma::patterns_of;
using nsma::PeriodSelection;
using nsma::Scene;

Scene scene_of(int cells, nsma::PatternSelection selection, double gap = 1) {
    Scene scene;
    scene.mesh.cells = cells;
    scene.bar.gap = gap;
    scene.patterns = std::move(selection);
    return scene;
}

TEST(Scene, FirstModePatternsByHand) {
    // N = 3, d > 0: T from 3 tau (excluded) to 4 tau (p >= 1): n_T = 10, 11; r = 2(n_T - 6).
    const auto patterns = patterns_of(scene_of(3, ModeSelection{1}));
    EXPECT_EQ(patterns, (std::vector<Pattern>{{3, 8, 2}, {3, 10, 1}}));
    // d = 0: T = 3 tau; d < 0: n_T = 7, 8.
    EXPECT_EQ(patterns_of(scene_of(3, ModeSelection{1}, 0)), (std::vector<Pattern>{{3, 6, 3}}));
    EXPECT_EQ(patterns_of(scene_of(3, ModeSelection{1}, -1)), (std::vector<Pattern>{{3, 2, 5}, {3, 4, 4}}));
}

TEST(Scene, EveryPatternOfThePeriodRangeInOrder) {
    const auto patterns = patterns_of(scene_of(6, PeriodSelection{{0.0, 4.0}, std::nullopt}));
    ASSERT_EQ(patterns.size(), 276U);  // sum of n_T - 1 over n_T = 2..24
    for (std::size_t i = 1; i < patterns.size(); ++i) {
        const auto& a = patterns[i - 1];
        const auto& b = patterns[i];
        EXPECT_TRUE(a.period_steps() < b.period_steps() ||
                    (a.period_steps() == b.period_steps() && a.free_steps < b.free_steps));
    }
}

TEST(Scene, DecimalBoundsAreMetExactly) {
    // 3.3 * 10 is 33 in decimals, below it in binary on some machines and above on others; the
    // bound is included from both sides, for every tenth.
    for (int tenths = 2; tenths <= 60; ++tenths) {
        const double ratio = tenths / 10.0;
        const auto patterns = patterns_of(scene_of(10, PeriodSelection{{ratio, ratio}, std::nullopt}));
        ASSERT_EQ(patterns.size(), static_cast<std::size_t>(tenths - 1)) << ratio;
        for (const auto& pattern : patterns) EXPECT_EQ(pattern.period_steps(), tenths);
    }
    // Between two steps there is nothing.
    EXPECT_TRUE(patterns_of(scene_of(10, PeriodSelection{{3.31, 3.39}, std::nullopt})).empty());
}

TEST(Scene, ContactRangeBoundsIncluded) {
    const auto patterns = patterns_of(scene_of(10, PeriodSelection{{1.0, 1.2}, std::array<double, 2>{0.3, 0.5}}));
    EXPECT_EQ(patterns.size(), 9U);  // n_T = 10, 11, 12 with p = 3, 4, 5
    for (const auto& pattern : patterns) {
        EXPECT_GE(pattern.contact_steps, 3);
        EXPECT_LE(pattern.contact_steps, 5);
        EXPECT_GE(pattern.period_steps(), 10);
        EXPECT_LE(pattern.period_steps(), 12);
    }
}

TEST(Scene, ListKeepsItsOrder) {
    const auto patterns = patterns_of(scene_of(6, ListSelection{{{16, 4}, {1, 1}, {23, 1}}}));
    EXPECT_EQ(patterns, (std::vector<Pattern>{{6, 16, 4}, {6, 1, 1}, {6, 23, 1}}));
}

TEST(Scene, RefusesPeriodsThatNoMeshCanCount) {
    EXPECT_THROW((void)patterns_of(scene_of(1000, PeriodSelection{{0, 1e9}, std::nullopt})), std::invalid_argument);
    EXPECT_THROW((void)patterns_of(scene_of(10, PeriodSelection{{0, std::nan("")}, std::nullopt})),
                 std::invalid_argument);
}

}  // namespace
