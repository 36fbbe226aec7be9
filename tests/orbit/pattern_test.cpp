#include "nsma/orbit/pattern.hpp"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "nsma/wave/mesh.hpp"

namespace {

using nsma::kernel_dimension;
using nsma::Pattern;
using nsma::patterns_in;

TEST(Pattern, RatiosByHand) {
    const Pattern pattern{6, 16, 4};
    EXPECT_EQ(pattern.period_steps(), 20);
    EXPECT_EQ(pattern.class_count(), 4);        // gcd(12, 20)
    EXPECT_EQ(pattern.frequency_ratio(), 1.2);  // 24/20
    EXPECT_EQ(pattern.period_ratio(), 20.0 / 6.0);
}

TEST(Pattern, KernelDimensionsByHand) {
    EXPECT_EQ(kernel_dimension({6, 16, 4}), 4);   // g = 4, q = 4, s = 0
    EXPECT_EQ(kernel_dimension({6, 23, 1}), 11);  // g = 12, q = 1, s = 11
    EXPECT_EQ(kernel_dimension({2, 6, 1}), 1);    // g = 1, q = 6, s = 0
    EXPECT_EQ(kernel_dimension({2, 5, 1}), 1);    // g = 2, q = 2, s = 1
    EXPECT_EQ(kernel_dimension({2, 5, 2}), 0);    // g = 1, q = 5, s = 0
    EXPECT_EQ(kernel_dimension({1, 1, 1}), 1);    // g = 2, q = 0, s = 1
    // The whole bar comes back to any state: A_f^{4N} A_c^{2N} = I.
    EXPECT_EQ(kernel_dimension({5, 20, 10}), 10);
}

TEST(Pattern, LargestAcceptedNumbersDoNotOverflow) {
    const Pattern largest{nsma::max_cells, nsma::max_period_steps - 1, 1};
    EXPECT_NO_THROW(nsma::validate(largest));
    // g = gcd(2e6, 1e7) = 2e6, q = floor((1e7 - 1)/2e6) = 4, s = 2e6 - 1: m = g - s.
    EXPECT_EQ(kernel_dimension(largest), 1);
    // q = floor((8e6 - 1)/2e6) = 3, s = 2e6 - 1 = m.
    EXPECT_EQ(kernel_dimension({nsma::max_cells, 7'999'999, 1}), 1'999'999);
    EXPECT_THROW(nsma::validate(Pattern{1, nsma::max_period_steps, 1}), std::invalid_argument);
    EXPECT_THROW(nsma::validate(Pattern{1, 2'147'483'647, 2'147'483'647}), std::invalid_argument);
}

TEST(Pattern, CountsOfSixCells) {
    const std::vector<Pattern> patterns = patterns_in(6, {.period_lo = 2, .period_hi = 24});
    EXPECT_EQ(patterns.size(), 276U);  // 1 + 2 + ... + 23
    int alive = 0;
    for (const Pattern& pattern : patterns) {
        alive += kernel_dimension(pattern) >= 1;
    }
    EXPECT_EQ(alive, 209);
}

TEST(Pattern, RangesAreOrderedAndBounded) {
    const std::vector<Pattern> expected = {{4, 1, 3}, {4, 2, 2}, {4, 2, 3}, {4, 3, 2}};
    EXPECT_EQ(patterns_in(4, {.period_lo = 4, .period_hi = 5, .contact_lo = 2, .contact_hi = 3}), expected);
    EXPECT_EQ(patterns_in(4, {.period_lo = -7, .period_hi = 2}), (std::vector<Pattern>{{4, 1, 1}}));
    EXPECT_TRUE(patterns_in(4, {.period_lo = 6, .period_hi = 5}).empty());
    EXPECT_TRUE(patterns_in(4, {.period_lo = 2, .period_hi = 5, .contact_lo = 5}).empty());
}

TEST(Pattern, Misuse) {
    EXPECT_THROW(nsma::validate(Pattern{0, 1, 1}), std::invalid_argument);
    EXPECT_THROW(nsma::validate(Pattern{nsma::max_cells + 1, 1, 1}), std::invalid_argument);
    EXPECT_THROW(nsma::validate(Pattern{1, 0, 1}), std::invalid_argument);
    EXPECT_THROW(nsma::validate(Pattern{1, 1, 0}), std::invalid_argument);
    EXPECT_THROW((void)kernel_dimension({1, -1, 1}), std::invalid_argument);
    EXPECT_THROW((void)patterns_in(0, {}), std::invalid_argument);
    EXPECT_THROW((void)patterns_in(1, {.period_hi = nsma::max_period_steps + 1}), std::invalid_argument);
}

}  // namespace
