// Forced response: linear response in closed form, the branch over the first mode, its jumps, and what comes of it
// again.
#include "study/forced/forced.hpp"

#include <cmath>
#include <mutex>
#include <numbers>

#include <gtest/gtest.h>

#include "nsma/orbit/backbone.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "study/forced/free_march.hpp"

namespace {

using namespace nsma;

Scene driven(int cells, double force, std::vector<double> frequencies) {
    Scene scene;
    scene.mesh.cells = cells;
    scene.damping = {Damping::Kind::tip, 0.02};
    Forcing forcing;
    forcing.amplitude = force;
    forcing.frequencies = std::move(frequencies);
    forcing.settle = 150;
    forcing.record = 60;
    scene.forcing = forcing;
    return scene;
}

std::vector<ForcedPoint> response(const Scene& scene, const std::vector<ForcedPoint>& known = {}) {
    return forced_response(scene, known, [](const ForcedPoint&) {});
}

const ForcedPoint& at(const std::vector<ForcedPoint>& points, bool up, double frequency) {
    for (const ForcedPoint& point : points) {
        if (point.up == up && point.frequency == frequency) return point;
    }
    throw std::runtime_error("no such point");
}

TEST(Forced, BelowTheWallItIsTheLinearResponse) {
    for (const auto kind : {Damping::Kind::tip, Damping::Kind::distributed}) {
        Scene scene = driven(80, 1e-3, {0.5, 0.8, 1.3, 2.2});
        scene.damping = {kind, 0.1};
        for (const ForcedPoint& point : response(scene)) {
            EXPECT_EQ(point.kind, ForcedKind::contact_free);
            EXPECT_EQ(point.periods, 1);
            EXPECT_EQ(point.contact_phases, 0);
            // Tip of the continuous bar: F tan(k L)/(Y S k), k^2 = (omega^2 - i alpha omega)/c^2, or with the dashpot
            // F/(i omega z S (zeta - i cot(omega tau))).
            const std::complex<double> i(0, 1);
            const double omega = point.frequency * std::numbers::pi / 2;
            const auto k = std::sqrt(omega * omega - i * 0.1 * omega);
            const auto tip =
                kind == Damping::Kind::tip ? 1.0 / (i * omega * (0.1 - i / std::tan(omega))) : std::tan(k) / k;
            // Samples of the tip miss its greatest value by a quarter step at most; cells damp to second order.
            EXPECT_NEAR(point.tip_greatest / (1e-3 * std::abs(tip)), 1.0, 2e-3) << point.frequency;
        }
    }
}

// The scene of the issue on a coarser mesh.
TEST(Forced, FollowsTheFirstModeUpAndNotDown) {
    std::vector<double> frequencies;
    for (int i = 0; i < 21; ++i) frequencies.push_back(0.96 + 0.01 * i);
    const Scene scene = driven(60, 0.05, frequencies);
    const auto points = response(scene);
    ASSERT_EQ(points.size(), 42U);
    for (const ForcedPoint& point : points) {
        EXPECT_LT(point.balance, 1e-12);
        EXPECT_EQ(point.peak_force == 0, point.kind == ForcedKind::contact_free);
    }
    for (const double frequency : {frequencies[10], frequencies[12], frequencies[14]}) {  // 1.06 to 1.10
        const ForcedPoint& up = at(points, true, frequency);
        EXPECT_NE(up.kind, ForcedKind::contact_free);
        EXPECT_NEAR(up.contact_phases, 1.0, 0.01);
        EXPECT_NEAR(up.energy_max / backbone_energy_ratio(1, 4 / frequency), 1.0, 0.12);
        const ForcedPoint& down = at(points, false, frequency);
        EXPECT_EQ(down.kind, ForcedKind::contact_free);
        EXPECT_LT(down.energy_max, 0.1 * up.energy_max);
    }
    // Up it falls off where the mode can take no more work than it loses; down it jumps up near 1.02.
    const auto found = jumps(points);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_FALSE(found[0].up);
    EXPECT_TRUE(found[0].rises);
    EXPECT_NEAR(found[0].from, 1.02, 0.011);
    EXPECT_TRUE(found[1].up);
    EXPECT_FALSE(found[1].rises);
    const auto predicted = predicted_jumps(balance_points(scene));
    ASSERT_EQ(predicted.size(), 1U);
    EXPECT_EQ(predicted[0].mode, 1);
    EXPECT_NEAR(predicted[0].frequency, 0.5 * (found[1].from + found[1].to), 0.025);
}

TEST(Forced, WhatStillGrowsOrBeatsIsNotCalledPeriodic) {
    Scene scene = driven(40, 1e-3, {1.0});
    scene.damping.value = 1e-3;  // rings up over hundreds of periods
    scene.forcing->settle = 0;
    for (const ForcedPoint& point : response(scene)) EXPECT_EQ(point.kind, ForcedKind::transient);
    scene.damping = {};  // beats with the mode, far below the wall
    scene.forcing->frequencies = {0.985};
    scene.forcing->record = 400;
    for (const ForcedPoint& point : response(scene)) EXPECT_EQ(point.kind, ForcedKind::quasi_periodic) << point.defect;
}

// Of a bar that is pressed against the wall the energy of a mode rises as its frequency falls.
TEST(Forced, ThePredictedEndIsWhereTheEnergyRises) {
    Scene scene = driven(100, 2.0, {1.36, 1.99});
    scene.bar.gap = -1;
    scene.damping.value = 0.2;
    const auto points = balance_points(scene);
    const auto ends = predicted_jumps(points);
    ASSERT_EQ(ends.size(), 1U);
    for (const BalancePoint& point : points) {
        if (point.mode != 1) continue;
        EXPECT_EQ(point.ratio < 1, point.frequency < ends[0].frequency || point.frequency > 1.931) << point.frequency;
    }
}

// Along mode 1 the orbit of least energy is known: the tip moves with 4 d/(T - 3 tau) in flight, to and fro.
TEST(Forced, TheBalanceOfTheFirstModeIsThatOfItsSawtooth) {
    const Scene scene = driven(200, 0.05, {1.0, 1.25});
    const auto points = balance_points(scene);
    ASSERT_GT(points.size(), 20U);
    for (const BalancePoint& point : points) {
        if (point.mode != 1) continue;
        // Free for 2 T - 4 tau with speed v = 1/(T - 3) in units of d/tau each way, then at the wall.
        const double period = 4 / point.frequency;
        const double speed = 1 / (period - 3), free = 2 * period - 4;
        const double omega = 2 * std::numbers::pi / period;
        const double loss = 0.02 * speed * speed * free;
        // |integral of v cos| of -speed, then +speed: 2 speed/omega (1 - cos(omega free/2)).
        const double work = 0.05 * 2 * speed / omega * (1 - std::cos(0.5 * omega * free));
        EXPECT_NEAR(point.ratio, work / loss, 2e-3 * work / loss) << point.frequency;
        EXPECT_NEAR(point.energy, speed * speed, 1e-9 * point.energy);
    }
}

TEST(Forced, EachRunIsTheSameAndGoesOnWhereItStopped) {
    Scene scene = driven(20, 0.05, {0.99, 1.02, 1.05, 1.08});
    scene.forcing->settle = 30;
    const auto whole = response(scene);
    const auto expect_same = [&](const std::vector<ForcedPoint>& other) {
        ASSERT_EQ(other.size(), whole.size());
        for (std::size_t i = 0; i < whole.size(); ++i) {
            EXPECT_EQ(other[i].waves, whole[i].waves);
            EXPECT_EQ(other[i].energy_max, whole[i].energy_max);
            EXPECT_EQ(other[i].section, whole[i].section);
        }
    };
    expect_same(response(scene));
    expect_same(response(scene, {whole[0], whole[1], whole[4]}));
    expect_same(response(scene, whole));
    // From rest every point is for itself: both sweeps have the same.
    scene.forcing->from_rest = true;
    const auto rest = response(scene);
    for (const double frequency : scene.forcing->frequencies)
        EXPECT_EQ(at(rest, true, frequency).waves, at(rest, false, frequency).waves);
    // What comes of a point that cannot be kept comes out, from whatever thread.
    EXPECT_THROW((void)forced_response(scene, {}, [](const ForcedPoint&) { throw std::domain_error("full"); }),
                 std::domain_error);
    scene.forcing.reset();
    EXPECT_THROW((void)response(scene), std::invalid_argument);
}

TEST(FreeMarch, AnOrbitLetGoKeepsItsPatternAndItsEnergy) {
    for (const auto& [free, contact] : {std::pair{48, 16}, std::pair{42, 19}, std::pair{56, 12}}) {
        const PatternProblem problem = pattern_problem({20, free, contact}, 1);
        const Orbit orbit = make_orbit({}, problem.kernel, problem.set.reduction.beta(problem.set.least));
        const FreeMarch march = free_march({}, Mesh{20}, initial_state(orbit), {}, 100'000L * (free + contact));
        EXPECT_EQ(march.energy_end, march.energy_start);
        EXPECT_EQ(march.landing, 0);
        // But for the first, whose beginning was not seen, and the last.
        ASSERT_GE(march.cycles.size(), 99'998U);
        for (const auto& cycle : march.cycles) {
            ASSERT_EQ(cycle.free, free);
            ASSERT_EQ(cycle.contact, contact);
        }
        EXPECT_NEAR(march.tip_least, tip_displacement(orbit).minCoeff(), 1e-12);
        EXPECT_NEAR(march.peak_force, -contact_force(orbit).minCoeff(), 1e-12);
    }
}

TEST(FreeMarch, WhatIsLostIsToldAndADifferenceHasItsSize) {
    const PatternProblem problem = pattern_problem({20, 48, 16}, 1);
    const Orbit orbit = make_orbit({}, problem.kernel, problem.set.reduction.beta(problem.set.least));
    const State start = initial_state(orbit);
    const State moved = perturbed({}, start, 1e-3);
    EXPECT_NEAR((moved - start).norm() / start.norm(), 1e-3, 1e-12);
    for (const Damping& damping :
         {Damping{}, Damping{Damping::Kind::tip, 0.02}, Damping{Damping::Kind::distributed, 0.01}}) {
        const FreeMarch march = free_march({}, Mesh{20}, moved, damping, 20'000);
        EXPECT_NEAR(march.energy_start - march.energy_end, march.loss + march.landing, 1e-12 * march.energy_start);
        EXPECT_GT(march.landing, 0);  // it no longer reaches the wall at the end of a step
    }
}

}  // namespace
