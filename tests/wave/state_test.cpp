#include "nsma/wave/state.hpp"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace {

using nsma::Bar;
using nsma::Mesh;
using nsma::State;

constexpr double rounding = 1e-14;  // sums of a few tens of equal terms

TEST(State, StaticStretchToTheWallStoresTheEnergyUnit) {
    const Bar bar{2.0, 210e9, 7850.0, 1e-4, 1e-4};
    const Mesh mesh{13};
    State state = State::Zero(26);
    state.head(13).setConstant(bar.young_modulus * bar.gap / bar.length);
    EXPECT_NEAR(nsma::tip_displacement(bar, mesh, state) / bar.gap, 1.0, rounding);
    EXPECT_NEAR(nsma::energy(bar, mesh, state) / bar.energy_unit(), 1.0, rounding);
}

TEST(State, UniformVelocityHasTheKineticEnergyOfTheMassAndNoStretch) {
    const Bar bar{2.0, 210e9, 7850.0, 1e-4, 1e-4};
    const Mesh mesh{13};
    State state = State::Zero(26);
    state.tail(13).setConstant(3.0);
    const double mass = 7850.0 * 2.0 * 1e-4;  // kg
    EXPECT_NEAR(nsma::energy(bar, mesh, state), 0.5 * mass * 9.0, 0.5 * mass * 9.0 * rounding);
    EXPECT_EQ(nsma::tip_displacement(bar, mesh, state), 0.0);
}

TEST(State, WrongSizesAndNonFiniteValuesAreMisuse) {
    const Bar bar;
    const Mesh mesh{3};
    EXPECT_THROW((void)nsma::energy(bar, mesh, State::Zero(5)), std::invalid_argument);
    EXPECT_THROW((void)nsma::tip_displacement(bar, mesh, State::Zero(7)), std::invalid_argument);
    EXPECT_THROW(nsma::validate(mesh, State::Zero(3)), std::invalid_argument);
    EXPECT_NO_THROW(nsma::validate(mesh, State::Zero(6)));
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        State state = State::Zero(6);
        state[4] = bad;
        EXPECT_THROW(nsma::validate(mesh, state), std::invalid_argument);
    }
}

}  // namespace
