#include "../bench/schedule.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace nsma {
namespace {

// Sums of a few thousand doubles: rounding only.
constexpr double rounding = 1e-9;

TEST(Schedule, OneWorkerTakesTheSum) {
    const Schedule schedule = simulated_schedule({1.0, 2.0, 3.0}, {1, 0.5, 0.25});
    // Four services and three round trips of two messages.
    EXPECT_NEAR(schedule.seconds, 6.0 + 4 * 0.5 + 6 * 0.25, rounding);
    EXPECT_NEAR(schedule.message_rate, 3 / schedule.seconds, rounding);
}

TEST(Schedule, EqualUnitsDivideEvenly) {
    const std::vector<double> units(1000, 0.01);
    for (const int workers : {1, 2, 10, 100}) {
        const Schedule schedule = simulated_schedule(units, {workers, 0.0, 0.0});
        EXPECT_NEAR(schedule.seconds, 10.0 / workers, rounding);
        EXPECT_NEAR(schedule.efficiency, 1.0, rounding);
    }
}

TEST(Schedule, TheLongestUnitIsABound) {
    EXPECT_NEAR(simulated_schedule({5.0, 1.0, 1.0}, {3, 0.0, 0.0}).seconds, 5.0, rounding);
    // Longest last is the worst order of two workers.
    EXPECT_NEAR(simulated_schedule({1.0, 1.0, 5.0}, {2, 0.0, 0.0}).seconds, 6.0, rounding);
}

TEST(Schedule, RankZeroIsABoundWithManyWorkers) {
    const std::vector<double> units(100'000, 0.02);
    const Schedule schedule = simulated_schedule(units, {1000, 1e-3, 0.0});
    EXPECT_NEAR(schedule.message_rate, 1000.0, 20.0);  // one a millisecond; start and end beside
    EXPECT_GT(schedule.busy, 0.99);
    EXPECT_LT(schedule.efficiency, 0.03);
}

TEST(Schedule, MisuseIsNamed) {
    EXPECT_THROW((void)simulated_schedule({}, {}), std::invalid_argument);
    EXPECT_THROW((void)simulated_schedule({1.0}, {0, 0.0, 0.0}), std::invalid_argument);
    EXPECT_THROW((void)simulated_schedule({-1.0}, {}), std::invalid_argument);
    EXPECT_THROW((void)simulated_schedule({1.0}, {1, -1.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
