// One motion under several labels is one motion.
#include "nsma/orbit/motion_label.hpp"

#include <random>

#include <gtest/gtest.h>

#include "../support/bar_with_gap.hpp"
#include "nsma/orbit/conditions.hpp"
#include "nsma/orbit/replay.hpp"

namespace {

using Eigen::VectorXd;
using nsma::Bar;
using nsma::LabelledMotion;
using nsma::least_label;
using nsma::Orbit;
using nsma::Pattern;

Orbit orbit_of(const Pattern& pattern, const VectorXd& beta, double gap = 1.0) {
    return nsma::make_orbit(bar_with_gap(gap), nsma::exact_kernel(pattern), beta);
}

bool same_motion(const LabelledMotion& a, const LabelledMotion& b) {
    const auto one = nsma::fingerprints(a), other = nsma::fingerprints(b);
    const bool shared = one[0] == other[0] || one[1] == other[1];
    bool equal = a.label.free_steps == b.label.free_steps && a.label.contact_steps == b.label.contact_steps;
    for (std::size_t n = 0; equal && n < a.waves.size(); ++n)
        equal = std::abs(a.waves[n] - b.waves[n]) <= 1e-9;  // waves of order one
    EXPECT_EQ(equal, shared);
    return equal;
}

// The orbit of a pattern with these waves b_n dt/u, if they are in its kernel.
std::optional<Orbit> with_waves(const Pattern& pattern, double gap, const std::vector<double>& waves) {
    const auto kernel = nsma::exact_kernel(pattern);
    VectorXd beta(kernel.dimension());
    for (int j = 0; j < beta.size(); ++j)
        beta[j] = waves[static_cast<std::size_t>(kernel.class_of[static_cast<std::size_t>(j)])];
    for (int n = 0; n < pattern.period_steps(); ++n) {
        const int column = kernel.column(n);
        const double wave = column < 0 ? 0.0 : kernel.sign[static_cast<std::size_t>(n)] * beta[column];
        if (std::abs(wave - waves[static_cast<std::size_t>(n)]) > 1e-12) return std::nullopt;
    }
    return nsma::make_orbit(bar_with_gap(gap), kernel, beta);
}

TEST(MotionLabel, RestIsNoMotion) { EXPECT_FALSE(least_label(orbit_of({2, 6, 1}, VectorXd::Zero(1)))); }

TEST(MotionLabel, APlainOrbitHasItsOwnLabel) {
    const auto motion = least_label(orbit_of({2, 6, 1}, VectorXd::Constant(1, -0.5)));
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->label.free_steps, 6);
    EXPECT_EQ(motion->label.contact_steps, 1);
    EXPECT_EQ(motion->label.shift_steps, 0);
}

TEST(MotionLabel, AFreeVibrationLabelledWithItsPeriodsManyTimesOver) {
    // N = 3, waves - 0 + 0: it waits at the wall for one step of four.
    const auto one = least_label(orbit_of({3, 3, 1}, VectorXd::Constant(1, -1.0)));
    ASSERT_TRUE(one);
    EXPECT_EQ(one->label.free_steps, 3);
    EXPECT_EQ(one->label.contact_steps, 1);
    for (const Pattern& pattern : {Pattern{3, 7, 1}, Pattern{3, 15, 1}}) {
        const auto other = least_label(orbit_of(pattern, VectorXd::Constant(1, -1.0)));
        ASSERT_TRUE(other);
        EXPECT_EQ(other->label, one->label);
        EXPECT_TRUE(same_motion(*one, *other));
    }
}

// Every simplex of a small mesh: amplitudes on a part of its classes leave contact steps without force, so that the
// motion rests at the wall and has the labels that take such steps from contact into flight, and back. All are one
// motion, its least label is a pattern that the marcher accepts, and so are its reversals.
TEST(MotionLabel, IsTheSameForEveryLabelShiftAndReversal) {
    std::mt19937_64 random(7);
    int orbits = 0, relabelled = 0, reversed = 0;
    for (const int gap_sign : {1, -1}) {
        for (int period = 2; period <= 24; ++period) {
            for (int draw = 0; draw < 4 * (period - 1); ++draw) {
                const int free = 1 + draw / 4;
                const Pattern pattern{6, free, period - free};
                const auto kernel = nsma::exact_kernel(pattern);
                if (kernel.dimension() < 3) continue;
                const auto conditions = nsma::conditions(kernel, gap_sign);
                VectorXd beta = VectorXd::Zero(kernel.dimension());
                for (Eigen::Index j = 0; j < beta.size(); ++j) {
                    const auto bound = conditions.bound_of[static_cast<std::size_t>(j)];
                    const double value = random() % 2 == 0 ? 0.0 : 0.1 + static_cast<double>(random() >> 11) * 0x1p-53;
                    if (bound == nsma::Conditions::Sign::nonnegative) beta[j] = value;
                    if (bound == nsma::Conditions::Sign::nonpositive) beta[j] = -value;
                }
                const double tip = nsma::contact_row(kernel).cast<double>().dot(beta);
                if (tip * gap_sign <= 0) continue;
                beta *= gap_sign / tip;
                const Orbit orbit = orbit_of(pattern, beta, gap_sign);
                if (!nsma::replay(orbit).accepted) continue;
                ++orbits;
                const auto motion = least_label(orbit);
                ASSERT_TRUE(motion);
                SCOPED_TRACE(testing::Message() << "(" << free << ", " << period - free << ") gap " << gap_sign);
                // The waves belong to the pattern named, which the marcher accepts.
                const Pattern least{6, motion->label.free_steps, motion->label.contact_steps};
                const auto again = with_waves(least, gap_sign, motion->waves);
                ASSERT_TRUE(again);
                EXPECT_TRUE(nsma::replay(*again).accepted);
                EXPECT_NEAR(nsma::energy_ratio(*again), nsma::energy_ratio(orbit),
                            1e-12 * nsma::energy_ratio(orbit));  // same sums
                const auto own = least_label(*again);
                ASSERT_TRUE(own);
                EXPECT_TRUE(same_motion(*own, *motion));
                EXPECT_EQ(own->label.shift_steps, 0);
                EXPECT_FALSE(own->label.reversed);
                EXPECT_LE(least.period_steps(), pattern.period_steps());
                EXPECT_TRUE(least.period_steps() < period || least.free_steps <= pattern.free_steps);
                if (!(least == pattern)) ++relabelled;
                // Backward in time: flight waves change sign and order, contact waves their order.
                std::vector<double> back(static_cast<std::size_t>(period));
                for (int n = 0; n < period; ++n) {
                    const int from = n < free ? free - 1 - n : free + period - 1 - n;
                    const int column = kernel.column(from);
                    const double wave = column < 0 ? 0.0 : kernel.sign[static_cast<std::size_t>(from)] * beta[column];
                    back[static_cast<std::size_t>(n)] = n < free ? -wave : wave;
                }
                const auto mirror = with_waves(pattern, gap_sign, back);
                ASSERT_TRUE(mirror);
                ASSERT_TRUE(nsma::replay(*mirror).accepted);
                const auto mirrored = least_label(*mirror);
                ASSERT_TRUE(mirrored);
                EXPECT_TRUE(same_motion(*mirrored, *motion));
                if (mirrored->label.reversed != motion->label.reversed) ++reversed;
            }
        }
    }
    EXPECT_GT(orbits, 100);
    EXPECT_GT(relabelled, 30);
    EXPECT_GT(reversed, 30);
}

TEST(MotionLabel, OtherMotionsAreOther) {
    // (6, 16, 4): a simplex of four amplitudes; two that are no shift or reversal of each other.
    const auto kernel = nsma::exact_kernel({6, 16, 4});
    const VectorXd row = nsma::contact_row(kernel).cast<double>();
    const VectorXd a = Eigen::Vector4d(0.4, 0.3, 0.2, 0.1).cwiseQuotient(row);
    const VectorXd b = Eigen::Vector4d(0.4, 0.2, 0.3, 0.1).cwiseQuotient(row);
    const auto one = least_label(orbit_of({6, 16, 4}, a));
    const auto other = least_label(orbit_of({6, 16, 4}, b));
    ASSERT_TRUE(one && other);
    EXPECT_FALSE(same_motion(*one, *other));
    EXPECT_TRUE(same_motion(*one, *one));
}

}  // namespace
