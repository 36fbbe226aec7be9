// The driven bar against the closed form of linear response, its energy balance, and what it does at the wall.
#include "wave/driven_bar.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "nsma/wave/marcher.hpp"

namespace {

using namespace nsma;
using Complex = std::complex<double>;
using Kind = Damping::Kind;

const Bar unit;
const Bar steel{0.3, 210e9, 7850.0, 1e-4, 1e-4};

// Far from the wall.
Bar apart(Bar bar) {
    bar.gap = 1e5 * bar.displacement_unit();
    return bar;
}

/// v/f of a bar held at one end in steady vibration, f per area at the other: z (zeta - i cot(omega tau)) f, or with
/// distributed damping i omega tan(k L)/(Y k), k = omega/c sqrt(1 - i alpha/omega).
Complex admittance(const Bar& bar, const Damping& damping, double omega) {
    const Complex i(0, 1);
    const double tau = bar.travel_time();
    if (damping.kind == Kind::distributed) {
        const Complex k = omega / bar.wave_speed() * std::sqrt(1.0 - i * damping.value / omega);
        return i * omega * std::tan(k * bar.length) / (bar.young_modulus * k);
    }
    return 1.0 / (bar.impedance() * (damping.value - i / std::tan(omega * tau)));
}

/// The same of the driven bar, after many periods: one Fourier coefficient of the tip's velocity over whole periods.
Complex measured(const Bar& bar, int cells, const Damping& damping, int period_steps, int settle) {
    DrivenBar driven(bar, Mesh{cells}, rest_state(bar, Mesh{cells}), damping);
    const double phase = 2 * std::numbers::pi / period_steps;
    Complex sum = 0;
    for (int n = 0; n < (settle + 1) * period_steps; ++n) {
        const double now = phase * (n + 0.5);
        const double velocity = driven.step(bar.area * std::cos(now)).tip_velocity;
        if (n >= settle * period_steps) sum += velocity * std::polar(1.0, -now);
    }
    return 2.0 * sum / static_cast<double>(period_steps);
}

TEST(DrivenBar, RespondsToADashpotAsTheContinuousBarDoes) {
    for (const Bar& bar : {apart(unit), apart(steel)}) {
        for (const int cells : {1, 3, 20}) {
            for (const double periods : {1.7, 3.3, 5.0}) {  // in tau
                const auto steps = static_cast<int>(std::lround(periods * cells)) + 2;
                const Damping damping{Kind::tip, 0.3};
                const double omega = 2 * std::numbers::pi / (steps * Mesh{cells}.time_step(bar));
                // Waves lose half their size a round trip; 2 000 periods leave nothing of the start. A staircase of the
                // force has the cosine as its first harmonic, times the same factor as that of the velocity.
                const Complex got = measured(bar, cells, damping, steps, 2000 / steps + 40);
                const Complex want = admittance(bar, damping, omega);
                EXPECT_LT(std::abs(got - want), 1e-12 * std::abs(want)) << cells << ' ' << steps;
            }
        }
    }
}

TEST(DrivenBar, DistributedDampingIsOfSecondOrder) {
    const Bar bar = apart(steel);
    const Damping damping{Kind::distributed, 0.8 / bar.travel_time()};
    double before = 0;
    for (const int cells : {10, 20, 40, 80}) {
        const int steps = 33 * cells / 10;
        const double omega = 2 * std::numbers::pi / (steps * Mesh{cells}.time_step(bar));
        const Complex want = admittance(bar, damping, omega);
        const double error = std::abs(measured(bar, cells, damping, steps, 40) - want) / std::abs(want);
        if (before > 0) {
            EXPECT_NEAR(before / error, 4.0, 0.3) << cells;
        }
        before = error;
    }
    EXPECT_LT(before, 1e-3);
}

TEST(DrivenBar, EveryJouleIsAccountedFor) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (const Bar& gapped : {unit, steel, Bar{.gap = -0.5}, Bar{.gap = 0.0}}) {
        for (const Damping& damping : {Damping{}, Damping{Kind::tip, 0.02}, Damping{Kind::distributed, 0.1}}) {
            const Mesh mesh{25};
            DrivenBar driven(gapped, mesh, rest_state(gapped, mesh), damping);
            double energy = driven.energy(), most = energy;
            const double force = 3 * gapped.force_unit();
            bool touched = false;
            for (int n = 0; n < 4000; ++n) {
                const auto step = driven.step(force * normal(random));
                energy += step.work - step.loss + step.landing;
                most = std::max(most, energy);
                // Sums of thousands of terms.
                ASSERT_NEAR(driven.energy(), energy, 1e-12 * most) << n;
                ASSERT_LE(driven.tip(), gapped.gap + 1e-10 * gapped.displacement_unit());
                EXPECT_LE(step.wall_force, 1e-9 * gapped.force_unit());
                touched = touched || step.wall_force < 0;
            }
            EXPECT_TRUE(touched);
        }
    }
}

TEST(DrivenBar, WithoutForceAndLossItMarchesAsTheJudgeDoes) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    const Mesh mesh{12};
    // Waves that bring the tip to the wall exactly at the end of a step: the judge asks for such states.
    for (int trial = 0; trial < 20; ++trial) {
        const Bar bar;
        State state = State::Zero(mesh.window());
        // Four equal waves of half the gap each: one free step and one contact step a wave.
        const double speed = 0.25 * (1 + trial % 2) / mesh.time_step(bar);
        for (int i = 0; i < mesh.cells; ++i) state[mesh.cells + i] = i % 4 == trial % 4 ? speed : 0.0;
        DrivenBar driven(bar, mesh, state, {});
        const MarchReport judged = march(bar, mesh, state, 200);
        const double energy = driven.energy();
        for (int n = 0; n < 200; ++n) {
            ASSERT_NEAR(driven.tip(), judged.first_period[static_cast<std::size_t>(n)].tip, 1e-12) << trial << ' ' << n;
            (void)driven.step(0.0);
        }
        EXPECT_NEAR(driven.energy(), energy, 1e-12 * energy);
    }
}

TEST(DrivenBar, Misuse) {
    const State rest = rest_state(unit, Mesh{3});
    for (const double value : {-0.1, std::numeric_limits<double>::infinity(), std::nan("")})
        EXPECT_THROW(DrivenBar(unit, Mesh{3}, rest, {Kind::tip, value}), std::invalid_argument);
    EXPECT_THROW(DrivenBar(unit, Mesh{4}, rest, {}), std::invalid_argument);
    EXPECT_THROW(DrivenBar(unit, Mesh{3}, (State(6) << 2, 2, 2, 0, 0, 0).finished(), {}),
                 std::invalid_argument);  // in the wall
}

}  // namespace
