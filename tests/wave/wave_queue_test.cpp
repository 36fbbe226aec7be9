#include "wave/wave_queue.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "wave/dense_wfem.hpp"

namespace {

using nsma::Bar;
using nsma::Mesh;
using nsma::State;
using nsma::WaveQueue;

const Bar bars[] = {{}, {0.3, 210e9, 7850.0, 1e-4, 1e-4}};
const int meshes[] = {1, 2, 3, 8, 21};

/// Velocities of order 1 m/s, stresses of order z.
State random_state(const Bar& bar, int cells, std::mt19937& random) {
    std::normal_distribution<double> normal;
    State state = State::NullaryExpr(2 * cells, [&](Eigen::Index) { return normal(random); });
    state.head(cells) *= bar.impedance();
    return state;
}

double relative_difference(const Bar& bar, const State& left, const State& right) {
    const Eigen::Index cells = left.size() / 2;
    State difference = left - right;
    difference.head(cells) /= bar.impedance();
    return difference.cwiseAbs().maxCoeff();
}

TEST(WaveQueue, FollowsTheLiteralSchemeThroughRandomContact) {
    std::mt19937 random(2);
    std::bernoulli_distribution coin;
    for (const Bar& bar : bars) {
        const double z = bar.impedance();
        for (const int cells : meshes) {
            const Mesh mesh{cells};
            const double dt = mesh.time_step(bar);
            State state = random_state(bar, cells, random);
            WaveQueue queue(bar, mesh, state);
            const double energy = nsma::energy(bar, mesh, state);
            double tip = nsma::tip_displacement(bar, mesh, state);
            // Velocities are of order 1 and displacements of order dt * 2N = 2 tau; the literal
            // scheme rounds in every cell and step, 300 steps.
            const double rounding = 300.0 * 1e-15 * 10.0;
            const double length = bar.travel_time();
            for (int n = 0; n < 300; ++n) {
                const double stress = state[cells - 1];
                const double velocity = state[2 * cells - 1];
                EXPECT_NEAR(queue.arriving(), 0.5 * (velocity - stress / z), rounding);
                EXPECT_NEAR(queue.contact_force() / (z * bar.area), stress / z - velocity, rounding);
                EXPECT_NEAR(queue.tip() / length, tip / length, rounding);
                EXPECT_NEAR(queue.tip() / length, nsma::tip_displacement(bar, mesh, state) / length, rounding);
                EXPECT_NEAR(queue.energy() / energy, 1.0, rounding);
                EXPECT_NEAR(nsma::energy(bar, mesh, state) / energy, 1.0, rounding);
                ASSERT_LT(relative_difference(bar, queue.state(), state), rounding);

                const bool contact = coin(random);
                // The interface velocity v* carries the tip: 0 in contact.
                const double tip_velocity = contact ? 0.0 : velocity - stress / z;
                if (contact) {
                    queue.step_contact();
                } else {
                    EXPECT_NEAR(queue.tip_after_free_step() / length, (tip + dt * tip_velocity) / length, rounding);
                    queue.step_free();
                }
                tip += dt * tip_velocity;
                nsma::dense::cell_step(bar, mesh, contact, state);
            }
        }
    }
}

TEST(WaveQueue, StateToQueueAndBack) {
    std::mt19937 random(3);
    for (const Bar& bar : bars) {
        for (const int cells : meshes) {
            const State state = random_state(bar, cells, random);
            // One sum and one difference of numbers of order 1.
            EXPECT_LT(relative_difference(bar, WaveQueue(bar, Mesh{cells}, state).state(), state), 4e-15);
        }
    }
}

TEST(WaveQueue, WavesAreTheTwoTravellingPartsOfTheState) {
    // N = 2, z = 1: cell 2 reaches the end first, then cell 1, then what cells 1 and 2 send to
    // the fixed end, reversed there.
    const State state = (State(4) << 1.0, 2.0, 10.0, 20.0).finished();
    const WaveQueue queue(Bar{}, Mesh{2}, state);
    EXPECT_EQ(queue.window(), 4);
    EXPECT_EQ(queue.wave(0), 9.0);    // (v2 - s2)/2
    EXPECT_EQ(queue.wave(1), 4.5);    // (v1 - s1)/2
    EXPECT_EQ(queue.wave(2), -5.5);   // -(v1 + s1)/2
    EXPECT_EQ(queue.wave(3), -11.0);  // -(v2 + s2)/2
    EXPECT_EQ(queue.tip(), 1.5);      // (s1 + s2) dx/Y
}

TEST(WaveQueue, WavesComeBackUnroundedAfterOneRoundTrip) {
    std::mt19937 random(4);
    std::bernoulli_distribution coin;
    const Bar& bar = bars[1];
    const int cells = 21;
    WaveQueue queue(bar, Mesh{cells}, random_state(bar, cells, random));
    for (int trip = 0; trip < 50; ++trip) {
        std::vector<double> expected;
        for (int n = 0; n < 2 * cells; ++n) {
            const double wave = queue.arriving();
            const bool contact = coin(random);
            expected.push_back(contact ? wave : -wave);
            contact ? queue.step_contact() : queue.step_free();
        }
        for (int k = 0; k < 2 * cells; ++k) {
            EXPECT_EQ(queue.wave(k), expected[static_cast<std::size_t>(k)]);
        }
    }
}

TEST(WaveQueue, TipDoesNotDriftOverAMillionSteps) {
    std::mt19937 random(5);
    const Bar bar;
    const int cells = 50;
    const State state = random_state(bar, cells, random);
    WaveQueue queue(bar, Mesh{cells}, state);
    const double tip = queue.tip();
    for (int n = 0; n < 5000 * 4 * cells; ++n) {  // 5 000 free periods
        queue.step_free();
    }
    EXPECT_EQ(queue.tip(), tip);  // resummed from the very same waves
}

TEST(WaveQueue, Misuse) {
    State state = State::Zero(6);
    EXPECT_THROW(WaveQueue(Bar{}, Mesh{2}, state), std::invalid_argument);
    EXPECT_THROW(WaveQueue(Bar{}, Mesh{0}, state), std::invalid_argument);
    EXPECT_THROW(WaveQueue(Bar{.length = -1.0}, Mesh{3}, state), std::invalid_argument);
    const WaveQueue queue(Bar{}, Mesh{3}, state);
    EXPECT_THROW((void)queue.wave(-1), std::invalid_argument);
    EXPECT_THROW((void)queue.wave(6), std::invalid_argument);
    state[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(WaveQueue(Bar{}, Mesh{3}, state), std::invalid_argument);
}

}  // namespace
