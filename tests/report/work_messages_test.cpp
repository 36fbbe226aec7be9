#include "study/sweep/work_messages.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "study/sweep/record_fields.hpp"
#include "study/sweep/sweep_queue.hpp"
#include "nsma/report/orbit_json.hpp"
#include "report/sweep/tables.hpp"

namespace nsma {
namespace {

Scene scene_of(double gap, Objective objective) {
    Scene scene;
    scene.bar.gap = gap;
    scene.mesh.cells = 6;
    scene.patterns = ListSelection{{{16, 4}, {23, 1}, {3, 3}, {11, 1}, {13, 1}, {4, 10}}};
    scene.levels = {0.5, 1.6, 3.0, 12.0, 1e4};
    scene.all_kinds = true;
    scene.objective = objective;
    return scene;
}

/// Every result of a sweep goes over the wire and into rows and back without a change.
void expect_round_trips(const Scene& scene) {
    SweepQueue queue(scene, {}, SweepQueue::Order::scene);
    SweepWorker worker(scene, {});
    int orbits = 0;
    while (!queue.finished()) {
        const auto results = worker.run(queue.next(0));
        const auto all_back = unpacked_results(packed(results), scene.bar);
        ASSERT_EQ(all_back.size(), results.size());
        for (std::size_t i = 0; i < results.size(); ++i) {
            const WorkResult& result = results[i];
            const WorkResult& back = all_back[i];
            queue.done(result);
            EXPECT_EQ(back.pattern, result.pattern);
            EXPECT_EQ(back.place, result.place);
            ASSERT_EQ(back.record.has_value(), result.record.has_value());
            ASSERT_EQ(back.answer.has_value(), result.answer.has_value());
            const ResultRows a = rows_of(result), b = rows_of(back);
            EXPECT_EQ(a.record, b.record);
            EXPECT_EQ(a.runs, b.runs);
            EXPECT_EQ(a.beta, b.beta);  // bit for bit
            if (result.record) {
                EXPECT_EQ(patterns_csv_row(scene.bar, *result.record), patterns_csv_row(scene.bar, *back.record));
            } else {
                EXPECT_EQ(levels_csv_row(scene.bar, *result.answer), levels_csv_row(scene.bar, *back.answer));
                EXPECT_EQ(orbit_json(*result.answer, scene.bar), orbit_json(*back.answer, scene.bar));
                EXPECT_EQ(timings_csv_rows(*result.answer), timings_csv_rows(*back.answer));
                if (result.answer->orbit) ++orbits;
            }
        }
    }
    EXPECT_GT(orbits, 0);
}

TEST(WorkMessages, ComeBackAsTheyWere) { expect_round_trips(scene_of(1.0, Objective::least_shock)); }
TEST(WorkMessages, ComeBackForAPrestressedBar) { expect_round_trips(scene_of(-0.5, Objective::least_force)); }
TEST(WorkMessages, ComeBackForAClosedGap) { expect_round_trips(scene_of(0.0, Objective::nearest)); }

TEST(WorkMessages, NoValueIsNotZero) {
    OrbitAnswer answer;
    answer.pattern = {6, 16, 4};
    answer.solvers.emplace_back();
    answer.solvers[0].objective = std::numeric_limits<double>::quiet_NaN();
    answer.optimality.emplace();  // without a bound
    const OrbitAnswer back =
        *unpacked_results(packed(std::vector{WorkResult{7, 2, std::nullopt, answer}}), Bar{}).at(0).answer;
    EXPECT_TRUE(std::isnan(back.solvers.at(0).objective));
    ASSERT_TRUE(back.optimality.has_value());
    EXPECT_FALSE(back.optimality->lower_bound.has_value());
    EXPECT_FALSE(back.replay.has_value());
    EXPECT_FALSE(back.level.has_value());
}

TEST(WorkMessages, UnitsComeBack) {
    const auto back = unpacked_units(packed(std::vector<WorkUnit>{{123456789012, 3, {0.1, -1e-300}}, {1, -1, {}}}));
    ASSERT_EQ(back.size(), 2u);
    EXPECT_EQ(back[0].pattern, 123456789012);
    EXPECT_EQ(back[0].place, 3);
    EXPECT_EQ(back[0].before, (std::vector<double>{0.1, -1e-300}));
    EXPECT_EQ(back[1].place, -1);
}

TEST(WorkMessages, OtherBytesAreRefused) {
    const std::string good = packed(
        std::vector{WorkResult{0, 0, std::nullopt, OrbitAnswer{}}, WorkResult{0, -1, PatternRecord{}, std::nullopt}});
    for (std::size_t size = 0; size < good.size(); ++size) {
        EXPECT_THROW((void)unpacked_results(good.substr(0, size), Bar{}), std::invalid_argument) << size;
    }
    EXPECT_THROW((void)unpacked_results(good + "x", Bar{}), std::invalid_argument);
    EXPECT_THROW((void)unpacked_units("short"), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
