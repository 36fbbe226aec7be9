#include "nsma/orbit/replay.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "../support/bar_with_gap.hpp"
#include "wave/dense_wfem.hpp"
#include "nsma/orbit/backbone.hpp"
#include "nsma/orbit/conditions.hpp"

namespace {

using Eigen::VectorXd;
using nsma::Bar;
using nsma::exact_kernel;
using nsma::Kernel;
using nsma::make_orbit;
using nsma::Orbit;
using nsma::Pattern;
using nsma::Replay;
using nsma::replay;

Orbit one_amplitude(const Pattern& pattern, double gap, double beta) {
    return make_orbit(bar_with_gap(gap), exact_kernel(pattern), VectorXd::Constant(1, beta));
}

TEST(Replay, AcceptsTheSmallestFirstModeOrbit) {
    const Replay verdict = replay(one_amplitude({2, 6, 1}, 1.0, -0.5), 4.0, 1000);
    EXPECT_TRUE(verdict.accepted);
    EXPECT_TRUE(verdict.same_labels);
    EXPECT_EQ(verdict.violations.worst(), 0.0);
    EXPECT_EQ(verdict.march.periodicity_defect, 0.0);
    EXPECT_EQ(verdict.march.periods, 1000);
}

TEST(Replay, MeasuresCondOne) {
    // N = 2, (2, 1): waves + - + of 1/2 u, tip -1 0 -1 -1 with the wall at -1: force
    // compressive, contact at the wall, but the free flight is inside the wall by |d|.
    const Replay verdict = replay(one_amplitude({2, 2, 1}, -1.0, 0.5));
    EXPECT_EQ(verdict.violations.cond1, 1.0);
    EXPECT_EQ(verdict.violations.cond2, 0.0);
    EXPECT_EQ(verdict.violations.cond3, 0.0);
    EXPECT_EQ(verdict.violations.periodicity, 0.0);
    EXPECT_FALSE(verdict.same_labels);
    EXPECT_FALSE(verdict.accepted);
}

TEST(Replay, MeasuresCondTwo) {
    // 1.001 times the orbit: 1e-3 beyond the wall in contact; 0.999: 1e-3 before it.
    const Replay beyond = replay(one_amplitude({2, 6, 1}, 1.0, -0.5 * 1.001));
    EXPECT_NEAR(beyond.violations.cond2, 1e-3, 1e-15);  // one rounding of 1.001
    EXPECT_NEAR(beyond.violations.cond1, 1e-3, 1e-15);
    EXPECT_FALSE(beyond.accepted);
    const Replay before = replay(one_amplitude({2, 6, 1}, 1.0, -0.5 * 0.999));
    EXPECT_NEAR(before.violations.cond2, 1e-3, 1e-15);
    EXPECT_EQ(before.violations.cond1, 0.0);
    EXPECT_FALSE(before.accepted);
}

TEST(Replay, MeasuresCondThree) {
    // The (6, 1) orbit upside down, at a wall at -1: contact pulls with all its force.
    const Replay verdict = replay(one_amplitude({2, 6, 1}, -1.0, 0.5));
    EXPECT_EQ(verdict.violations.cond3, 1.0);
    EXPECT_EQ(verdict.violations.cond2, 0.0);
    EXPECT_FALSE(verdict.accepted);
}

TEST(Replay, MeasuresTheEnergyOfItsOwnState) {
    const Orbit orbit = one_amplitude({2, 6, 1}, 1.0, -0.5);
    EXPECT_NEAR(replay(orbit, 5.0).violations.energy, 0.2, 1e-15);  // |4 - 5|/5
    EXPECT_FALSE(replay(orbit, 5.0).accepted);
    EXPECT_FALSE(replay(orbit, 4.0 * (1.0 + 1e-8)).accepted);
    EXPECT_TRUE(replay(orbit, 4.0 * (1.0 + 1e-10)).accepted);
    EXPECT_FALSE(replay(orbit, 4.0 * (1.0 + 1e-10), 1, 1e-11).accepted);
    EXPECT_EQ(replay(orbit).violations.energy, 0.0);
}

TEST(Replay, MeasuresPeriodicity) {
    // A kernel whose signs are tampered with: b_1 with the wrong sign is not periodic any more.
    Orbit orbit = one_amplitude({2, 6, 1}, 1.0, -0.5);
    orbit.kernel.sign[1] = -1;
    const Replay verdict = replay(orbit);
    EXPECT_GT(verdict.violations.periodicity, 0.5);  // whole waves out of place
    EXPECT_FALSE(verdict.accepted);
}

TEST(Replay, ClosedGapIsRelativeToTheLargestDisplacement) {
    // N = 2, (4, 2): eps = + + - - - -, so x_0 = 0 whatever beta, and beta <= 0.
    const Kernel kernel = exact_kernel({2, 4, 2});
    ASSERT_EQ(nsma::contact_row(kernel), Eigen::VectorXi::Zero(2));
    for (const double size : {1e-6, 1.0, 1e6}) {
        const VectorXd beta = (VectorXd(2) << -size, -1.1 * size).finished();
        const Orbit orbit = make_orbit(bar_with_gap(0.0), kernel, beta);
        EXPECT_TRUE(replay(orbit, 8.0 * beta.squaredNorm(), 1000).accepted);  // 4 N^2/g = 8
        const Replay mirrored = replay(make_orbit(bar_with_gap(0.0), kernel, -beta));
        EXPECT_FALSE(mirrored.accepted);
        EXPECT_EQ(mirrored.violations.cond1, 1.0);  // its whole flight is inside the wall
        EXPECT_EQ(mirrored.violations.cond3, 1.0);
        // N = 6, (16, 4), equal amplitudes: the tip goes from 4 size down to -12 size in 8 steps,
        // and stays at 4 size in contact.
        const Replay off =
            replay(make_orbit(bar_with_gap(0.0), exact_kernel({6, 16, 4}), VectorXd::Constant(4, -size)));
        EXPECT_NEAR(off.violations.cond2, 1.0 / 3.0, 1e-15);  // sums of 12 equal numbers
        EXPECT_FALSE(off.accepted);
    }
    // Rest at the closed wall: every step silent, nothing violated.
    EXPECT_TRUE(replay(make_orbit(bar_with_gap(0.0), kernel, VectorXd::Zero(2))).accepted);
    // Rest away from an open wall is no contact orbit: x = 0 in "contact".
    EXPECT_EQ(replay(make_orbit(bar_with_gap(1.0), kernel, VectorXd::Zero(2))).violations.cond2, 1.0);
}

TEST(Replay, FourClassesBetweenLeastAndMostEnergy) {
    // N = 6, (16, 4): beta <= 0 with sum -1 (by hand, conditions_test): from -1/4 each,
    // E/E_g = 36/4 = 9, to a single -1, E/E_g = 36. The vertices have three silent contact steps.
    const Kernel kernel = exact_kernel({6, 16, 4});
    const Bar bar;
    EXPECT_TRUE(replay(make_orbit(bar, kernel, VectorXd::Constant(4, -0.25)), 9.0, 1000).accepted);
    for (int vertex = 0; vertex < 4; ++vertex) {
        VectorXd beta = VectorXd::Zero(4);
        beta[vertex] = -1.0;
        const Replay verdict = replay(make_orbit(bar, kernel, beta), 36.0, 1000);
        EXPECT_TRUE(verdict.accepted) << vertex;
    }
    VectorXd mixed(4);
    mixed << -0.1, -0.2, -0.3, -0.4;
    EXPECT_TRUE(replay(make_orbit(bar, kernel, mixed), 36.0 * 0.3, 1000).accepted);
    mixed << 0.1, -0.3, -0.4, -0.4;  // the first contact step pulls: 0.1 against 0.4
    // One rounding of each amplitude.
    EXPECT_NEAR(replay(make_orbit(bar, kernel, mixed)).violations.cond3, 0.25, 1e-14);
}

/// On mode 1 every beta of the sign of COND3 on the plane of COND2 is an orbit: a simplex. Points
/// of it with amplitudes over 15 decades push the wall by any small force, let go of it at any
/// small speed, touch it in flight: none may be lost to a tolerance.
TEST(Replay, AcceptsEveryPointOfTheFirstModeSimplex) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> decades(0.0, 15.0);
    int cases = 0;
    for (const int cells : {6, 8, 12, 20}) {
        for (const int gap_sign : {1, -1}) {
            for (const Pattern& pattern : nsma::mode_patterns(1, cells, gap_sign)) {
                const Kernel kernel = exact_kernel(pattern);
                const int m = kernel.dimension();
                const VectorXd row = nsma::contact_row(kernel).cast<double>();
                for (int trial = 0; trial < m + 20; ++trial) {
                    VectorXd weight = VectorXd::Zero(m);
                    if (trial < m) {
                        weight[trial] = 1.0;  // a vertex
                    } else {
                        weight =
                            VectorXd::NullaryExpr(m, [&](Eigen::Index) { return std::pow(10.0, -decades(random)); });
                    }
                    const VectorXd beta = gap_sign * weight.cwiseQuotient(row) / weight.sum();
                    const Replay verdict = replay(make_orbit(bar_with_gap(gap_sign), kernel, beta), std::nullopt, 50);
                    ASSERT_TRUE(verdict.accepted) << "N " << cells << ", r " << pattern.free_steps << ", p "
                                                  << pattern.contact_steps << ", beta " << beta.transpose();
                    // Nothing but rounding of 2N waves of order |d|.
                    ASSERT_LT(verdict.march.periodicity_defect, 1e-13);
                    ASSERT_LT(verdict.violations.worst(), 1e-12);
                    ++cases;
                }
            }
        }
    }
    EXPECT_GT(cases, 1000);
    RecordProperty("cases", cases);
}

TEST(Replay, AmplitudesWithNoForceAreNotDividedByNoise) {
    // N = 2, (6, 2): waves a(- - 0 0 + + 0 0), contact without force. A contact wave of 1e-17
    // in place of 0 must not be read as full tension.
    const Kernel kernel = exact_kernel({2, 6, 2});
    ASSERT_EQ(kernel.class_of, (std::vector<int>{0, 1}));
    const Replay verdict = replay(make_orbit(Bar{}, kernel, VectorXd::Constant(2, -0.5)));
    EXPECT_TRUE(verdict.accepted);
    EXPECT_EQ(verdict.violations.cond3, 0.0);
    Orbit noisy = make_orbit(Bar{}, exact_kernel({3, 3, 1}), VectorXd::Constant(1, -1.0));
    EXPECT_TRUE(replay(noisy).accepted);
    noisy.bar = {1.0, 210e9, 7850.0, 1e-4, 1e-4};  // the same, with rounding of units
    EXPECT_TRUE(replay(noisy, std::nullopt, 1000).accepted);
}

/// For every pattern with m = 1 and its only candidate, the verdict is that of the three
/// conditions read off the literal scheme.
TEST(Replay, VerdictIsThatOfTheLiteralScheme) {
    int accepted = 0;
    int rejected = 0;
    for (const Bar& bar : {bar_with_gap(1.0), bar_with_gap(-1.0), Bar{1.0, 210e9, 7850.0, 1e-4, 1e-4}}) {
        for (int cells = 1; cells <= 6; ++cells) {
            for (const Pattern& pattern : nsma::patterns_in(cells, {.period_hi = 6 * cells})) {
                const Kernel kernel = exact_kernel(pattern);
                if (kernel.dimension() != 1 || nsma::contact_row(kernel)[0] == 0) {
                    continue;
                }
                const Orbit orbit = make_orbit(
                    bar, kernel, VectorXd::Constant(1, bar.gap_sign() / double(nsma::contact_row(kernel)[0])));
                const nsma::Mesh mesh{cells};
                nsma::State state = nsma::initial_state(orbit);
                // Everything is a multiple of |d|/(2N) or so, hence far from 1e-6 when not zero.
                const double tolerance = 1e-6;
                bool admissible = true;
                for (int n = 0; n <= pattern.period_steps(); ++n) {
                    const double distance = nsma::tip_displacement(bar, mesh, state) - bar.gap;
                    const bool contact = n >= pattern.free_steps;
                    const double stress = state[cells - 1] - bar.impedance() * state[2 * cells - 1];
                    admissible = admissible && distance <= tolerance * std::abs(bar.gap);
                    if (contact && n < pattern.period_steps()) {
                        admissible = admissible && std::abs(distance) <= tolerance * std::abs(bar.gap) &&
                                     bar.area * stress <= tolerance * bar.force_unit();
                    }
                    nsma::dense::cell_step(bar, mesh, contact, state);
                }
                const Replay verdict = replay(orbit, std::nullopt, 20);
                ASSERT_EQ(verdict.accepted, admissible) << "N " << cells << ", r " << pattern.free_steps << ", p "
                                                        << pattern.contact_steps << ", gap " << bar.gap;
                ++(admissible ? accepted : rejected);
            }
        }
    }
    EXPECT_GT(accepted, 100);
    EXPECT_GT(rejected, 500);
}

TEST(Replay, Misuse) {
    const Orbit orbit = one_amplitude({2, 6, 1}, 1.0, -0.5);
    EXPECT_THROW((void)replay(orbit, 0.0), std::invalid_argument);
    EXPECT_THROW((void)replay(orbit, -1.0), std::invalid_argument);
    EXPECT_THROW((void)replay(orbit, std::nan("")), std::invalid_argument);
    EXPECT_THROW((void)replay(orbit, std::nullopt, 0), std::invalid_argument);
    EXPECT_THROW((void)replay(orbit, std::nullopt, 1, -1.0), std::invalid_argument);
}

}  // namespace
