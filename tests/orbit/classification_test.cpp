#include "nsma/orbit/classification.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "nsma/orbit/replay.hpp"

namespace {

using Eigen::VectorXd;
using nsma::Bar;
using nsma::Classification;
using nsma::classify;
using nsma::exact_kernel;
using nsma::make_orbit;
using nsma::Orbit;
using nsma::Pattern;

Orbit of(const Pattern& pattern, const VectorXd& beta, double gap = 1.0) {
    Bar bar;
    bar.gap = gap;
    return make_orbit(bar, exact_kernel(pattern), beta);
}

TEST(Classification, FirstModeIsPlain) {
    const Classification kind = classify(of({2, 6, 1}, VectorXd::Constant(1, -0.5)));
    EXPECT_EQ(kind.minimal_period_steps, 7);
    EXPECT_EQ(kind.silent_contact_steps, 0);
    EXPECT_EQ(kind.wall_touches, 0);
    EXPECT_TRUE(kind.full_support);
    EXPECT_EQ(kind.tolerance, 1e-9);
}

TEST(Classification, OneMotionUnderThreeLabels) {
    // N = 3, waves - 0 + 0 and tip 1 -1 -1 1 (1): a linear mode that waits at the wall without
    // force. Labels (3, 1), and, twice and four times over, (7, 1) and (15, 1).
    const int touches[] = {0, 2, 6};
    int i = 0;
    for (const Pattern& pattern : {Pattern{3, 3, 1}, Pattern{3, 7, 1}, Pattern{3, 15, 1}}) {
        const Orbit orbit = of(pattern, VectorXd::Constant(1, -1.0));
        const VectorXd tip = nsma::tip_displacement(orbit);
        for (int n = 0; n < tip.size(); ++n) {
            EXPECT_EQ(tip[n], n % 4 == 0 || n % 4 == 3 ? 1.0 : -1.0);
        }
        const Classification kind = classify(orbit);
        EXPECT_EQ(kind.minimal_period_steps, 4);
        EXPECT_EQ(kind.silent_contact_steps, 1);
        EXPECT_EQ(kind.wall_touches, touches[i++]);
        EXPECT_TRUE(kind.full_support);
        EXPECT_TRUE(nsma::replay(orbit, std::nullopt, 1000).accepted);
    }
}

TEST(Classification, FreeVibrationLabelledWithTwoOfItsPeriods) {
    // N = 2, waves - - 0 0 + + 0 0 (times 1/2 u): 1 0 -1 -1 -1 0 1 1 1. As (14, 2) the first
    // period's wait at the wall, n = 6, 7, 8, is a touch.
    const Classification one = classify(of({2, 6, 2}, VectorXd::Constant(2, -0.5)));
    EXPECT_EQ(one.minimal_period_steps, 8);
    EXPECT_EQ(one.silent_contact_steps, 2);
    EXPECT_EQ(one.wall_touches, 0);
    const Orbit orbit = of({2, 14, 2}, VectorXd::Constant(2, -0.5));
    const Classification two = classify(orbit);
    EXPECT_EQ(two.minimal_period_steps, 8);
    EXPECT_EQ(two.silent_contact_steps, 2);
    EXPECT_EQ(two.wall_touches, 3);
    EXPECT_TRUE(two.full_support);
    EXPECT_TRUE(nsma::replay(orbit, std::nullopt, 1000).accepted);
}

TEST(Classification, VertexHasZeroAmplitudesAndSilentSteps) {
    // N = 6, (16, 4): one of four classes alone carries the whole motion.
    VectorXd beta = VectorXd::Zero(4);
    beta[2] = -1.0;
    const Classification vertex = classify(of({6, 16, 4}, beta));
    EXPECT_FALSE(vertex.full_support);
    EXPECT_EQ(vertex.silent_contact_steps, 3);
    EXPECT_EQ(vertex.minimal_period_steps, 20);
    const Classification centre = classify(of({6, 16, 4}, VectorXd::Constant(4, -0.25)));
    EXPECT_TRUE(centre.full_support);
    EXPECT_EQ(centre.silent_contact_steps, 0);
    EXPECT_EQ(centre.minimal_period_steps, 20);
}

TEST(Classification, ToleranceIsRelativeToTheLargestAmplitude) {
    VectorXd beta(4);
    beta << -1.0, -1e-12, 0.0, -1e-6;
    EXPECT_EQ(classify(of({6, 16, 4}, beta)).silent_contact_steps, 2);
    EXPECT_EQ(classify(of({6, 16, 4}, beta), 1e-5).silent_contact_steps, 3);
    EXPECT_EQ(classify(of({6, 16, 4}, beta), 0.0).silent_contact_steps, 1);
    EXPECT_EQ(classify(of({6, 16, 4}, 1e-20 * beta)).silent_contact_steps, 2);
}

TEST(Classification, TouchesAreCountedAgainstWhicheverWall) {
    // N = 3, (5, 1), d = -1: g = 6, class 5 alone lives, in contact: the tip rests at the wall
    // while one wave runs up and down: touches at n = 1..4.
    const Classification pressed = classify(of({3, 5, 1}, VectorXd::Constant(1, 1.0), -1.0));
    EXPECT_EQ(pressed.wall_touches, 4);
    EXPECT_EQ(pressed.silent_contact_steps, 0);
    // N = 2, (4, 2), d = 0: tip 0 -1 -2 -1 0 0 in units of its amplitude, no touch in flight.
    EXPECT_EQ(classify(of({2, 4, 2}, VectorXd::Constant(2, -1e-3), 0.0)).wall_touches, 0);
}

TEST(Classification, RestAndMisuse) {
    const Classification rest = classify(of({6, 16, 4}, VectorXd::Zero(4)));
    EXPECT_EQ(rest.minimal_period_steps, 1);
    EXPECT_EQ(rest.silent_contact_steps, 4);
    EXPECT_FALSE(rest.full_support);
    EXPECT_FALSE(classify(of({2, 5, 2}, VectorXd(0))).full_support);
    EXPECT_THROW((void)classify(of({6, 16, 4}, VectorXd::Zero(4)), -1.0), std::invalid_argument);
}

}  // namespace
