#include "nsma/wave/marcher.hpp"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "wave/dense_wfem.hpp"

namespace {

using nsma::Bar;
using nsma::march;
using nsma::MarchReport;
using nsma::Mesh;
using nsma::State;

/// The state whose waves b_0..b_{2N-1} [m/s] are given: cell i holds the wave that arrives after
/// N - i steps and the one that arrives, reversed at the fixed end, after N + i - 1 steps.
State state_of_waves(const Bar& bar, const std::vector<double>& waves) {
    const auto cells = static_cast<Eigen::Index>(waves.size() / 2);
    State state(2 * cells);
    for (Eigen::Index i = 1; i <= cells; ++i) {
        const double toward = waves[static_cast<std::size_t>(cells - i)];
        const double away = waves[static_cast<std::size_t>(cells + i - 1)];
        state[i - 1] = -bar.impedance() * (toward + away);
        state[cells + i - 1] = toward - away;
    }
    return state;
}

/// First nonsmooth mode by hand, derived on paper: the tip leaves the wall at speed 2a for r/2
/// steps, comes back at 2a for r/2 steps, stays p steps; r = 2(n_T - 2N), p = 4N - n_T, and
/// a (2T - 6 tau) = d. Its waves are -a (r/2 times), then +a.
State first_mode(const Bar& bar, int cells, int period_steps) {
    const int free_steps = 2 * (period_steps - 2 * cells);
    const double period_ratio = static_cast<double>(period_steps) / cells;
    const double a = bar.gap / (bar.travel_time() * (2.0 * period_ratio - 6.0));
    std::vector<double> waves;
    for (int n = 0; n < 2 * cells; ++n) {
        waves.push_back(n % period_steps < free_steps / 2 ? -a : a);
    }
    return state_of_waves(bar, waves);
}

std::vector<bool> contact_flags(const MarchReport& report) {
    std::vector<bool> flags;
    for (const nsma::MarchedStep& step : report.first_period) {
        flags.push_back(step.contact);
    }
    return flags;
}

Bar steel() { return {1.0, 210e9, 7850.0, 1e-4, 1e-4}; }

TEST(Marcher, FreeVibrationBelowTheGapStaysFree) {
    // A bar let go from a static stretch of half the gap: triangle wave of period 4 tau.
    const Bar bar;
    const Mesh mesh{10};
    State state = State::Zero(20);
    state.head(10).setConstant(0.5);
    const MarchReport report = march(bar, mesh, state, 40, 1000);
    EXPECT_EQ(report.free_steps, 40);
    EXPECT_EQ(report.contact_steps, 0);
    EXPECT_EQ(report.contact_phases, 0);
    EXPECT_EQ(report.worst_penetration, 0.0);
    EXPECT_EQ(report.largest_force, 0.0);
    EXPECT_EQ(report.periodicity_defect, 0.0);  // the queue only flips signs
    EXPECT_EQ(report.energy_drift, 0.0);
    EXPECT_EQ(report.periods, 1000);
    for (int n = 0; n <= 20; ++n) {  // tip from 0.5 down to -0.5, 0.05 a step
        EXPECT_NEAR(report.first_period[static_cast<std::size_t>(n)].tip, 0.5 - 0.05 * n, 1e-15);
    }
}

TEST(Marcher, FirstLinearModeThatJustGrazesStaysFree) {
    // Sinusoidal stress cos(pi s/2L) averaged over each cell, tip amplitude equal to the gap: the
    // tip comes back to x = d up to rounding in every period and must not be read as contact.
    for (const Bar& bar : {Bar{}, steel()}) {
        for (const int cells : {7, 20, 33}) {
            State state = State::Zero(2 * cells);
            for (int i = 0; i < cells; ++i) {
                // cell mean of Y d (pi/2L) cos(pi s/2L) = Y d/dx [sin(pi s/2L)]
                const double half_pi = std::acos(0.0);
                state[i] = bar.young_modulus * bar.gap * cells / bar.length *
                           (std::sin(half_pi * (i + 1) / cells) - std::sin(half_pi * i / cells));
            }
            const MarchReport report = march(bar, Mesh{cells}, state, 4 * cells, 100);
            EXPECT_EQ(report.contact_steps, 0);
            EXPECT_EQ(report.largest_force, 0.0);
            EXPECT_EQ(report.periodicity_defect, 0.0);
            // Rounding of a sum of 2N waves.
            EXPECT_LT(report.worst_penetration / bar.gap, 1e-14);
        }
    }
}

TEST(Marcher, SilentTouchInFreeFlightIsNotContact) {
    // N = 2, dt = 1/2, gap 1. The tip waits at the wall for two steps without force, moves away
    // and comes back: 1 1 1 0 -1 -1 -1 0 1.
    const Bar bar;
    const MarchReport report = march(bar, Mesh{2}, state_of_waves(bar, {0.0, 0.0, -1.0, -1.0}), 8, 1000);
    const double tips[] = {1, 1, 1, 0, -1, -1, -1, 0};
    const bool silent[] = {true, true, false, false, false, false, false, false};
    for (std::size_t n = 0; n < 8; ++n) {
        EXPECT_EQ(report.first_period[n].tip, tips[n]);
        EXPECT_EQ(report.first_period[n].silent, silent[n]) << n;
        EXPECT_FALSE(report.first_period[n].contact);
    }
    EXPECT_EQ(report.periodicity_defect, 0.0);
    EXPECT_EQ(report.worst_penetration, 0.0);
}

TEST(Marcher, SilentStepDuringContactStaysContact) {
    // N = 2, dt = 1/2, gap 1 = -dt (1 + 0 - 1 - 2): push, no force, release.
    const Bar bar;
    const MarchReport report = march(bar, Mesh{2}, state_of_waves(bar, {1.0, 0.0, -1.0, -2.0}), 6);
    EXPECT_EQ(contact_flags(report), (std::vector<bool>{true, true, false, false, false, false}));
    const double tips[] = {1, 1, 1, 0, -2, -1};
    const double forces[] = {-2, 0, 0, 0, 0, 0};  // -2 z S b
    for (std::size_t n = 0; n < 6; ++n) {
        EXPECT_EQ(report.first_period[n].tip, tips[n]);
        EXPECT_EQ(report.first_period[n].contact_force, forces[n]);
        EXPECT_EQ(report.first_period[n].silent, n == 1);
    }
    EXPECT_EQ(report.worst_tension, 0.0);
    EXPECT_EQ(report.worst_separation, 0.0);
    EXPECT_EQ(report.largest_force, 2.0);
}

TEST(Marcher, LastSmallStepToATouchIsNotContactHoweverSmall) {
    // N = 2, dt = 1/2, gap 1: 1-e, 1 (touch), 0, -1, -1+e, -1, 0, 1, whatever e: the step from 1-e
    // to 1 ends nearer to the wall than it starts.
    const Bar bar;
    for (int digits = 1; digits <= 17; ++digits) {
        const double e = std::pow(10.0, -digits);
        const MarchReport report = march(bar, Mesh{2}, state_of_waves(bar, {e, -1.0, -1.0, e}), 8, 100);
        EXPECT_EQ(report.contact_steps, 0) << e;
        EXPECT_EQ(report.largest_force, 0.0) << e;
        // e is added to 1 and taken off again once, on the way into the queue.
        EXPECT_LT(report.periodicity_defect, 1e-15) << e;
    }
}

TEST(Marcher, WeakPushAtTheWallIsHeldHoweverWeak) {
    // N = 2, dt = 1/2, gap 1: at the wall with wave e, then the waves of a release: the tip must
    // stay at 1 in the first step and the wave must come back with its sign, e again at n = 4.
    const Bar bar;
    for (int digits = 1; digits <= 17; ++digits) {
        const double e = std::pow(10.0, -digits);
        const MarchReport report = march(bar, Mesh{2}, state_of_waves(bar, {e, -1.0, -1.0, -e}), 4);
        const double rounding = 1e-15;  // e added to 1 and taken off again
        EXPECT_NEAR(report.first_period[1].tip, 1.0, rounding) << e;
        EXPECT_NEAR(report.first_period[2].tip, 0.0, rounding) << e;
        EXPECT_TRUE(report.first_period[0].contact || report.first_period[0].silent) << e;
        // b_0..b_3 = e, -1, -1, -e return as e, 1, 1, e: ||change|| = sqrt(8 + 4 e^2),
        // ||b|| = sqrt(2 + 2 e^2).
        const double change = std::sqrt((8.0 + 4.0 * e * e) / (2.0 + 2.0 * e * e));
        EXPECT_NEAR(report.periodicity_defect, change, 1e-14) << e;
    }
}

TEST(Marcher, TensionWithinTheSilentToleranceDoesNotEndContact) {
    const Bar bar;
    // The middle wave is tension: 1e-12 of the largest is rounding, 1e-6 is a release.
    const MarchReport noise = march(bar, Mesh{2}, state_of_waves(bar, {1.0, -1e-12, 1.0, -4.0}), 3);
    EXPECT_EQ(contact_flags(noise), (std::vector<bool>{true, true, true}));
    EXPECT_EQ(noise.worst_tension, 0.0);  // it moves as a release, without force
    const MarchReport release = march(bar, Mesh{2}, state_of_waves(bar, {1.0, -1e-6, 1.0, -4.0}), 3);
    EXPECT_EQ(contact_flags(release), (std::vector<bool>{true, false, true}));
    EXPECT_EQ(release.contact_phases, 1);  // n = 2; n = 0 follows contact at n = 2
    EXPECT_EQ(release.worst_tension, 0.0);
}

TEST(Marcher, SmallestFirstModeOrbitByHand) {
    // N = 2, n_T = 7: r = 6, p = 1, a = 1, E = 2 = 4 E_g. Tip 1 0 -1 -2 -1 0 1.
    const Bar bar;
    const State state = state_of_waves(bar, {-1.0, -1.0, -1.0, 1.0});
    EXPECT_EQ(nsma::energy(bar, Mesh{2}, state), 2.0);
    const MarchReport report = march(bar, Mesh{2}, state, 7, 1000);
    const double tips[] = {1, 0, -1, -2, -1, 0, 1};
    for (std::size_t n = 0; n < 7; ++n) {
        EXPECT_EQ(report.first_period[n].tip, tips[n]);
        EXPECT_EQ(report.first_period[n].contact, n == 6);
        EXPECT_EQ(report.first_period[n].contact_force, n == 6 ? -2.0 : 0.0);
    }
    EXPECT_EQ(report.free_steps, 6);
    EXPECT_EQ(report.contact_steps, 1);
    EXPECT_EQ(report.contact_phases, 1);
    EXPECT_EQ(report.worst_penetration, 0.0);
    EXPECT_EQ(report.worst_separation, 0.0);
    EXPECT_EQ(report.worst_tension, 0.0);
    EXPECT_EQ(report.periodicity_defect, 0.0);
    EXPECT_EQ(report.energy_drift, 0.0);
}

TEST(Marcher, SeesFreeAndContactStepsOfEveryFirstModeOrbit) {
    int cases = 0;
    for (const Bar& material : {Bar{}, steel()}) {
        for (const int cells : {4, 9, 20}) {
            for (int period_steps = 2 * cells + 1; period_steps < 4 * cells; ++period_steps) {
                if (period_steps == 3 * cells) {
                    continue;  // infinite energy
                }
                Bar bar = material;  // stiffening above 3 tau, prestressed below
                bar.gap = period_steps > 3 * cells ? material.gap : -material.gap;
                const State state = first_mode(bar, cells, period_steps);
                const MarchReport report = march(bar, Mesh{cells}, state, period_steps, 1000);
                EXPECT_EQ(report.free_steps, 2 * (period_steps - 2 * cells));
                EXPECT_EQ(report.contact_steps, 4 * cells - period_steps);
                EXPECT_EQ(report.contact_phases, 1);
                // Waves are rounded once, on the way into the queue; displacements are sums of
                // 2N <= 40 waves, each up to |d| / (2N |2T/tau - 6|/2) <= |d| in these meshes.
                EXPECT_LT(report.periodicity_defect, 1e-15);
                EXPECT_LT(report.energy_drift, 1e-15);
                const double gap = std::abs(bar.gap);
                EXPECT_LT(report.worst_penetration / gap, 1e-13);
                EXPECT_LT(report.worst_separation / gap, 1e-13);
                EXPECT_EQ(report.worst_tension, 0.0);
                ++cases;
            }
        }
    }
    EXPECT_EQ(cases, 2 * (7 - 1 + 17 - 1 + 39 - 1));
}

TEST(Marcher, SteelBarGivesTheFiguresOfTheUnitBar) {
    const int cells = 20;
    for (const int period_steps : {63, 70, 79}) {
        const Bar unit;
        const MarchReport one = march(unit, Mesh{cells}, first_mode(unit, cells, period_steps), period_steps, 10);
        const Bar bar = steel();
        const MarchReport two = march(bar, Mesh{cells}, first_mode(bar, cells, period_steps), period_steps, 10);
        for (std::size_t n = 0; n < one.first_period.size(); ++n) {
            EXPECT_EQ(one.first_period[n].contact, two.first_period[n].contact);
            EXPECT_EQ(one.first_period[n].silent, two.first_period[n].silent);
            // Sums of 40 waves of order d.
            EXPECT_NEAR(one.first_period[n].tip, two.first_period[n].tip / bar.gap, 1e-12);
            EXPECT_NEAR(one.first_period[n].contact_force, two.first_period[n].contact_force / bar.force_unit(), 1e-12);
        }
    }
}

TEST(Marcher, WrongAmplitudeIsSeen) {
    const Bar bar;
    const State orbit = first_mode(bar, 20, 71);
    // 1.001 times the orbit starts beyond the wall by 1e-3 of the gap.
    const MarchReport more = march(bar, Mesh{20}, 1.001 * orbit, 71);
    EXPECT_NEAR(more.worst_penetration, 1e-3, 1e-12);  // sums of 40 waves
    // 0.999 times the orbit meets the wall in the middle of a step: contact is seen off the wall,
    // one phase before the label or after, or the motion is not periodic any more.
    const MarchReport less = march(bar, Mesh{20}, 0.999 * orbit, 71, 3);
    EXPECT_GT(less.worst_separation + less.periodicity_defect, 1e-4);
}

TEST(Marcher, PerturbedCellIsNotPeriodic) {
    const Bar bar;
    State state = first_mode(bar, 20, 71);
    state[20 + 7] += 0.1;  // one velocity: two of the 40 waves, of size 0.909, change by 0.05
    // A period that is not the linear one moves them elsewhere: 0.1/(0.909 sqrt(40)) or so.
    EXPECT_GT(march(bar, Mesh{20}, state, 71).periodicity_defect, 1e-2);
}

TEST(Marcher, StateThatWouldPenetrateSwitchesToContact) {
    // Uniform velocity 1, N = 10, dt = 0.1, gap 0.35: tip 0, .1, .2, .3, then the next free step
    // would reach .4: contact from n = 3 until the waves turn to tension at n = 10.
    Bar bar;
    bar.gap = 0.35;
    State state = State::Zero(20);
    state.tail(10).setConstant(1.0);
    const MarchReport report = march(bar, Mesh{10}, state, 12);
    for (int n = 0; n < 12; ++n) {
        EXPECT_EQ(report.first_period[static_cast<std::size_t>(n)].contact, n >= 3 && n < 10) << n;
    }
    EXPECT_EQ(report.contact_steps, 7);
    EXPECT_EQ(report.contact_phases, 1);
    EXPECT_NEAR(report.worst_separation, 0.05, 1e-15);
    EXPECT_EQ(report.worst_penetration, 0.0);
    EXPECT_EQ(report.largest_force, 1.0);  // 2 z S b, b = 1/2
}

TEST(Marcher, EveryStepIsAStepOfTheLiteralScheme) {
    // Whatever it decides, its motion must be that of A_f and A_c, and no free step may end
    // beyond the wall, no contact step pull.
    Bar bar;
    for (const double gap : {0.4, 0.0, -0.4}) {
        bar.gap = gap;
        const Mesh mesh{9};
        State state = State::Zero(18);
        for (int i = 0; i < 18; ++i) {
            state[i] = std::sin(1.0 + 3.7 * i);
        }
        state[0] += gap * 9 - 0.1 - state.head(9).sum();  // starts 0.1/9 short of the wall
        const MarchReport report = march(bar, mesh, state, 400);
        EXPECT_GT(report.contact_phases, 2);
        for (const nsma::MarchedStep& step : report.first_period) {
            // 400 steps of rounding in the literal scheme.
            ASSERT_NEAR(step.tip, nsma::tip_displacement(bar, mesh, state), 1e-12);
            ASSERT_NEAR(step.contact_force, step.contact ? state[8] - state[17] : 0.0, 1e-12);
            nsma::dense::cell_step(bar, mesh, step.contact, state);
        }
        EXPECT_LT(report.worst_penetration, 1e-8);  // the touch tolerance
        EXPECT_LT(report.worst_tension, 1e-8);      // the silent tolerance
    }
}

TEST(Marcher, PrestressedBarAtRestStaysInContact) {
    // Pressed by d = -1: uniform stress -1, force Y S d/L = -1 for ever.
    Bar bar;
    bar.gap = -1.0;
    State state = State::Zero(10);
    state.head(5).setConstant(-1.0);
    const MarchReport report = march(bar, Mesh{5}, state, 13, 10);
    EXPECT_EQ(report.contact_steps, 13);
    EXPECT_EQ(report.contact_phases, 0);  // it never begins
    EXPECT_EQ(report.largest_force, 1.0);
    EXPECT_EQ(report.worst_tension, 0.0);
    EXPECT_LT(report.worst_separation, 1e-15);
    EXPECT_EQ(report.periodicity_defect, 0.0);
}

TEST(Marcher, ClosedGapOrbitByHand) {
    // Mode 1 at T = 3 tau, N = 2, n_T = 6: leaves and returns at speed 2a, r = 4, p = 2; waves
    // -a -a a a a a and any a. Tip 0 -1 -2 -1 0 0 for a = 1, dt = 1/2.
    Bar bar;
    bar.gap = 0.0;
    const MarchReport report = march(bar, Mesh{2}, state_of_waves(bar, {-1.0, -1.0, 1.0, 1.0}), 6, 1000);
    const double tips[] = {0, -1, -2, -1, 0, 0};
    for (std::size_t n = 0; n < 6; ++n) {
        EXPECT_EQ(report.first_period[n].tip, tips[n]);
        EXPECT_EQ(report.first_period[n].contact, n >= 4);
    }
    EXPECT_EQ(report.periodicity_defect, 0.0);
    EXPECT_EQ(report.worst_penetration, 0.0);
}

TEST(Marcher, RestDividesByNothing) {
    Bar bar;
    for (const double gap : {1.0, 0.0, -1.0}) {
        bar.gap = gap;
        const MarchReport report = march(bar, Mesh{3}, State::Zero(6), 5, 2);
        EXPECT_EQ(report.periodicity_defect, 0.0);
        EXPECT_EQ(report.energy_drift, 0.0);
        EXPECT_EQ(report.largest_force, 0.0);
        EXPECT_EQ(report.worst_penetration, gap < 0.0 ? 1.0 : 0.0);
        EXPECT_EQ(report.contact_steps, gap < 0.0 ? 5 : 0);
        EXPECT_EQ(report.first_period[0].silent, gap == 0.0);
    }
}

TEST(Marcher, WrongPeriodHasADefect) {
    const Bar bar;
    const MarchReport report = march(bar, Mesh{20}, first_mode(bar, 20, 71), 70);
    EXPECT_GT(report.periodicity_defect, 0.1);  // waves +-a shifted by one: 2 sqrt(flips/2N)
}

TEST(Marcher, Misuse) {
    const Bar bar;
    State state = State::Zero(6);
    EXPECT_THROW((void)march(bar, Mesh{3}, State::Zero(4), 5), std::invalid_argument);
    EXPECT_THROW((void)march(bar, Mesh{0}, state, 5), std::invalid_argument);
    EXPECT_THROW((void)march(bar, Mesh{3}, state, 0), std::invalid_argument);
    EXPECT_THROW((void)march(bar, Mesh{3}, state, 5, 0), std::invalid_argument);
    EXPECT_THROW((void)march(bar, Mesh{3}, state, 5, 1, {.touch_tolerance = -1.0}), std::invalid_argument);
    EXPECT_THROW((void)march(bar, Mesh{3}, state, 5, 1, {.silent_tolerance = std::numeric_limits<double>::quiet_NaN()}),
                 std::invalid_argument);
    state[2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)march(bar, Mesh{3}, state, 5), std::invalid_argument);
}

}  // namespace
