#include "nsma/wave/bar.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using nsma::Bar;

// A handful of roundings in closed formulas.
constexpr double rounding = 1e-15;

Bar steel() { return {1.0, 210e9, 7850.0, 1e-4, 1e-4}; }

TEST(Bar, UnitBarHasUnitSpeedImpedanceAndTime) {
    const Bar bar;
    EXPECT_EQ(bar.wave_speed(), 1.0);
    EXPECT_EQ(bar.impedance(), 1.0);
    EXPECT_EQ(bar.travel_time(), 1.0);
    EXPECT_EQ(bar.displacement_unit(), 1.0);
    EXPECT_EQ(bar.energy_unit(), 0.5);
    EXPECT_EQ(bar.force_unit(), 1.0);
}

TEST(Bar, SteelBarByHand) {
    const Bar bar = steel();
    // sqrt(210e9/7850) = 5172.194153...: squared it must give back Y/rho.
    EXPECT_NEAR(bar.wave_speed(), 5172.194153, 1e-6);  // digits written above
    EXPECT_NEAR(bar.wave_speed() * bar.wave_speed() * 7850.0 / 210e9, 1.0, rounding);
    EXPECT_NEAR(bar.impedance() / (7850.0 * bar.wave_speed()), 1.0, rounding);
    EXPECT_NEAR(bar.travel_time() * bar.wave_speed(), 1.0, rounding);
    EXPECT_EQ(bar.displacement_unit(), 1e-4);
    EXPECT_NEAR(bar.energy_unit(), 0.5 * 210e9 * 1e-4 * 1e-8, 0.105 * rounding);  // 0.105 J
    EXPECT_NEAR(bar.force_unit(), 2100.0, 2100.0 * rounding);
}

TEST(Bar, GapSignAndUnitsOfEveryKindOfGap) {
    Bar bar = steel();
    EXPECT_EQ(bar.gap_sign(), 1);
    const double open_energy = bar.energy_unit();
    bar.gap = -1e-4;
    EXPECT_EQ(bar.gap_sign(), -1);
    EXPECT_EQ(bar.displacement_unit(), 1e-4);
    EXPECT_EQ(bar.energy_unit(), open_energy);
    bar.gap = 0.0;
    EXPECT_EQ(bar.gap_sign(), 0);
    EXPECT_EQ(bar.energy_unit(), 1.0);
    // The static stretch by the displacement unit stores Y S u^2 / (2 L) = 1 J.
    const double stretch = bar.displacement_unit();
    EXPECT_NEAR(0.5 * 210e9 * 1e-4 * stretch * stretch, 1.0, rounding);
    bar.gap = -0.0;
    EXPECT_EQ(bar.gap_sign(), 0);
}

TEST(Bar, ValidateNamesTheQuantityAndTheValue) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const auto message = [](const Bar& bar) -> std::string {
        try {
            nsma::validate(bar);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message(Bar{}), "accepted");
    EXPECT_EQ(message(steel()), "accepted");
    EXPECT_EQ(message(Bar{.gap = 0.0}), "accepted");
    EXPECT_EQ(message(Bar{.gap = -2.0}), "accepted");
    EXPECT_EQ(message(Bar{.length = -1.0}), "length: expected a number from 1e-09 to 1e+06, got -1");
    for (const double bad : {0.0, -1.0, nan, infinity}) {
        EXPECT_THAT(message(Bar{.length = bad}), testing::StartsWith("length: expected"));
        EXPECT_THAT(message(Bar{.young_modulus = bad}), testing::StartsWith("young_modulus: "));
        EXPECT_THAT(message(Bar{.density = bad}), testing::StartsWith("density: expected"));
        EXPECT_THAT(message(Bar{.area = bad}), testing::StartsWith("area: expected"));
    }
    EXPECT_THAT(message(Bar{.gap = nan}), testing::StartsWith("gap: expected"));
    EXPECT_THAT(message(Bar{.gap = infinity}), testing::StartsWith("gap: expected"));
    EXPECT_THAT(message(Bar{.young_modulus = 1e60}), testing::StartsWith("young_modulus: expected"));
    EXPECT_THAT(message(Bar{.gap = -1e-200}), testing::StartsWith("gap: expected 0 or a size"));
}

TEST(Bar, WhateverIsAcceptedHasDerivedQuantitiesThatAreNumbers) {
    // Every corner of what is accepted.
    for (int corner = 0; corner < 64; ++corner) {
        Bar bar;
        int bit = 1;
        for (const auto& quantity : nsma::bar_quantities) {
            bar.*quantity.value = (corner & bit) != 0 ? quantity.greatest : quantity.least;
            bit *= 2;
        }
        bar.gap = (corner & 16) != 0 ? nsma::greatest_gap : nsma::least_gap;
        if ((corner & 32) != 0) bar.gap = -bar.gap;
        EXPECT_NO_THROW(nsma::validate(bar));
        for (const double gap : {bar.gap, 0.0}) {
            bar.gap = gap;
            for (const double derived : {bar.wave_speed(), bar.impedance(), bar.travel_time(), bar.displacement_unit(),
                                         bar.energy_unit(), bar.force_unit()}) {
                // Far from the ends of double, so that products of a few of them are numbers too.
                EXPECT_GT(derived, 1e-75) << corner;
                EXPECT_LT(derived, 1e75) << corner;
            }
        }
    }
}

}  // namespace
