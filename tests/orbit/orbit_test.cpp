#include "nsma/orbit/orbit.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "wave/dense_wfem.hpp"

namespace {

using Eigen::VectorXd;
using nsma::Bar;
using nsma::exact_kernel;
using nsma::make_orbit;
using nsma::Mesh;
using nsma::Orbit;
using nsma::Pattern;
using nsma::State;

const Bar steel{1.0, 210e9, 7850.0, 1e-4, 1e-4};
const Pattern patterns[] = {{6, 16, 4}, {6, 23, 1}, {3, 3, 1}, {8, 1, 1}, {20, 48, 16}};

Orbit random_orbit(const Bar& bar, const Pattern& pattern, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const nsma::Kernel kernel = exact_kernel(pattern);
    const VectorXd beta = VectorXd::NullaryExpr(kernel.dimension(), [&](Eigen::Index) { return normal(random); });
    return make_orbit(bar, kernel, beta);
}

TEST(Orbit, SmallestFirstModeByHand) {
    // N = 2, (6, 1), z = c = 1, dt = 1/2, alpha = beta/dt = -1: waves - - - + + + +. Cell 2 holds
    // b_0 and b_3, cell 1 holds b_1 and b_2: sigma_i = -(sum), v_i = difference.
    const Orbit orbit = make_orbit(Bar{}, exact_kernel({2, 6, 1}), VectorXd::Constant(1, -0.5));
    EXPECT_EQ(nsma::amplitudes(orbit), VectorXd::Constant(1, -1.0));
    EXPECT_EQ(nsma::initial_state(orbit), (State(4) << 2.0, 0.0, 0.0, -2.0).finished());
    EXPECT_EQ(nsma::period(orbit), 3.5);
    EXPECT_EQ(nsma::energy_ratio(orbit), 4.0);
    EXPECT_EQ(nsma::energy(orbit), 2.0);
    EXPECT_EQ(nsma::tip_displacement(orbit), (VectorXd(8) << 1, 0, -1, -2, -1, 0, 1, 1).finished());
    EXPECT_EQ(nsma::contact_force(orbit), (VectorXd(7) << 0, 0, 0, 0, 0, 0, -2).finished());
    EXPECT_EQ(orbit.mesh().cells, 2);
}

TEST(Orbit, FollowsTheLiteralScheme) {
    for (Bar bar : {Bar{}, steel}) {
        for (const double gap : {bar.gap, -bar.gap, 0.0}) {
            bar.gap = gap;
            for (const Pattern& pattern : patterns) {
                const Orbit orbit = random_orbit(bar, pattern, 9);
                const int cells = pattern.cells;
                const Mesh mesh{cells};
                const double z = bar.impedance();
                const double unit = bar.displacement_unit();
                const double speed = unit / mesh.time_step(bar);  // of the waves, m/s
                const VectorXd tip = nsma::tip_displacement(orbit);
                const VectorXd force = nsma::contact_force(orbit);
                const nsma::Field field = nsma::field(orbit);
                ASSERT_EQ(field.stress.rows(), cells);
                ASSERT_EQ(field.velocity.cols(), pattern.period_steps());
                State state = nsma::initial_state(orbit);
                // Energy: a closed formula against a sum of 2N squares.
                EXPECT_NEAR(nsma::energy(orbit) / nsma::energy(bar, mesh, state), 1.0, 4e-15);
                // Up to 64 steps of rounding on waves of a few times `speed`.
                const double rounding = 1e-12;
                for (int n = 0; n < pattern.period_steps(); ++n) {
                    const bool contact = n >= pattern.free_steps;
                    EXPECT_NEAR(tip[n] / unit, nsma::tip_displacement(bar, mesh, state) / unit, rounding);
                    const double end_stress = contact ? state[cells - 1] - z * state[2 * cells - 1] : 0.0;
                    EXPECT_NEAR(force[n] / (z * speed * bar.area), end_stress / (z * speed), rounding);
                    EXPECT_LT((field.stress.col(n) - state.head(cells)).cwiseAbs().maxCoeff() / (z * speed), rounding);
                    EXPECT_LT((field.velocity.col(n) - state.tail(cells)).cwiseAbs().maxCoeff() / speed, rounding);
                    nsma::dense::cell_step(bar, mesh, contact, state);
                }
                EXPECT_EQ(tip[pattern.period_steps()], tip[0]);
                EXPECT_EQ(tip[pattern.free_steps], tip[0]);
            }
        }
    }
}

TEST(Orbit, UnitsOnlyScale) {
    const Pattern pattern{20, 48, 16};
    const Orbit unit = random_orbit(Bar{}, pattern, 10);
    const Orbit metal = random_orbit(steel, pattern, 10);
    EXPECT_EQ(nsma::energy_ratio(unit), nsma::energy_ratio(metal));
    // A few roundings of units, relative to the largest value (waves of order 1: 40 of them).
    EXPECT_LT((nsma::tip_displacement(unit) - nsma::tip_displacement(metal) / 1e-4).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((nsma::contact_force(unit) - nsma::contact_force(metal) / steel.force_unit()).cwiseAbs().maxCoeff(),
              1e-12);
    EXPECT_NEAR(nsma::period(metal) / steel.travel_time(), nsma::period(unit), 1e-15 * 4.0);
}

TEST(Orbit, TrivialKernelIsRest) {
    const Orbit orbit = make_orbit(Bar{}, exact_kernel({2, 5, 2}), VectorXd(0));
    EXPECT_EQ(nsma::energy(orbit), 0.0);
    EXPECT_EQ(nsma::initial_state(orbit), State::Zero(4));
    EXPECT_EQ(nsma::tip_displacement(orbit), VectorXd::Zero(8));
}

TEST(Orbit, Misuse) {
    const nsma::Kernel kernel = exact_kernel({6, 16, 4});
    EXPECT_THROW((void)make_orbit(Bar{}, kernel, VectorXd::Zero(3)), std::invalid_argument);
    EXPECT_THROW((void)make_orbit(Bar{.area = -1.0}, kernel, VectorXd::Zero(4)), std::invalid_argument);
    VectorXd beta = VectorXd::Zero(4);
    beta[2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)make_orbit(Bar{}, kernel, beta), std::invalid_argument);
}

}  // namespace
