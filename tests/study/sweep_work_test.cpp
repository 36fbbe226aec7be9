#include "nsma/study/sweep_work.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace nsma {
namespace {

Scene scene_of(Objective objective = Objective::least_shock) {
    Scene scene;
    scene.mesh.cells = 4;
    scene.patterns = PeriodSelection{{0.0, 4.0}, std::nullopt};
    scene.levels = {1.6, 6.0, 300.0};
    scene.objective = objective;
    return scene;
}

/// A made-up result: every third pattern is admissible.
WorkResult made_up(const WorkUnit& unit) {
    WorkResult result{unit.pattern, unit.place, std::nullopt, std::nullopt};
    if (unit.place < 0) {
        result.record.emplace().verdict = unit.pattern % 3 == 0 ? Verdict::admissible : Verdict::inadmissible;
    } else {
        result.answer.emplace().verdict = Verdict::above;
    }
    return result;
}

using Key = std::pair<long, int>;

std::set<Key> all_units(const Scene& scene, int first, int last) {
    std::set<Key> units;
    const long count = static_cast<long>(patterns_of(scene).size());
    for (long pattern = 0; pattern < count; ++pattern) {
        units.insert({pattern, -1});
        for (int place = first; pattern % 3 == 0 && place <= last; ++place) units.insert({pattern, place});
    }
    return units;
}

TEST(SweepQueue, OneWorkerTakesTheScenesOrder) {
    const Scene scene = scene_of();
    SweepQueue queue(scene, SweepQueue::Order::scene);
    std::vector<Key> seen;
    while (!queue.finished()) {
        const auto unit = queue.next(0);
        ASSERT_TRUE(unit);
        seen.emplace_back(unit->pattern, unit->place);
        queue.done(made_up(*unit));
    }
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(std::set<Key>(seen.begin(), seen.end()), all_units(scene, 0, 3));
    EXPECT_EQ(queue.done_count(), queue.total_count());
    EXPECT_FALSE(queue.next(0));
}

TEST(SweepQueue, ManyWorkersTakeEachUnitOnceThoughSomeAreLost) {
    std::mt19937 random(5);
    for (const Objective objective : {Objective::least_shock, Objective::nearest, Objective::min_energy}) {
        const Scene scene = scene_of(objective);
        SweepQueue queue(scene, SweepQueue::Order::longest_first);
        std::map<int, WorkUnit> held;
        std::set<Key> seen;
        while (!queue.finished()) {
            const int worker = static_cast<int>(random() % 5);
            const auto hand = held.find(worker);
            if (hand == held.end()) {
                if (auto unit = queue.next(worker)) held[worker] = *unit;
                continue;
            }
            if (random() % 10 == 0) {
                queue.lost(worker);
            } else {
                const WorkUnit& unit = hand->second;
                EXPECT_TRUE(seen.emplace(unit.pattern, unit.place).second);
                queue.done(made_up(unit));
            }
            held.erase(hand);
        }
        EXPECT_TRUE(held.empty());
        const bool extreme = objective == Objective::min_energy;
        EXPECT_EQ(seen, all_units(scene, extreme ? 1 : 0, extreme ? 1 : 3));
        EXPECT_EQ(queue.done_count(), queue.total_count());
    }
}

TEST(SweepQueue, LongestComesFirst) {
    const Scene scene = scene_of();
    const auto patterns = patterns_of(scene);
    SweepQueue queue(scene, SweepQueue::Order::longest_first);
    double last = 1e300;
    for (int worker = 0; worker < static_cast<int>(patterns.size()); ++worker) {
        const auto unit = queue.next(worker);
        ASSERT_TRUE(unit);
        const Pattern& pattern = patterns[static_cast<std::size_t>(unit->pattern)];
        const double work = static_cast<double>(kernel_dimension(pattern)) * pattern.period_steps();
        EXPECT_LE(work, last);
        last = work;
    }
}

TEST(SweepQueue, GoesOnWhereAStoreEnds) {
    const Scene scene = scene_of();
    for (std::size_t stored = 0; stored < 60; ++stored) {
        SweepQueue whole(scene, SweepQueue::Order::scene);
        SweepQueue rest(scene, SweepQueue::Order::scene);
        std::set<Key> seen;
        while (!whole.finished()) {
            const auto unit = *whole.next(0);
            whole.done(made_up(unit));
            if (seen.size() >= stored) break;
            rest.done(made_up(unit));
            seen.emplace(unit.pattern, unit.place);
        }
        while (!rest.finished()) {
            const auto unit = *rest.next(0);
            rest.done(made_up(unit));
            EXPECT_TRUE(seen.emplace(unit.pattern, unit.place).second);
        }
        EXPECT_EQ(seen, all_units(scene, 0, 3));
    }
}

TEST(SweepQueue, NearestFollowsThePatternFromLevelToLevel) {
    Scene scene = scene_of(Objective::nearest);
    scene.mesh.cells = 6;
    scene.patterns = ListSelection{{{23, 1}}};
    scene.levels = {1.6, 2.0, 2.5};
    SweepQueue queue(scene, SweepQueue::Order::longest_first);
    SweepWorker worker(scene, {});
    SweepWorker other(scene, {});
    queue.done(worker.run(*queue.next(0)));
    std::vector<double> beta;
    for (int place = 0; place <= 3; ++place) {
        const auto unit = queue.next(0);
        ASSERT_TRUE(unit);
        EXPECT_EQ(unit->place, place);
        EXPECT_EQ(unit->reference, beta);
        if (place > 0) {
            EXPECT_FALSE(queue.next(1));  // it needs this one
        } else {
            const auto first = queue.next(1);
            EXPECT_FALSE(first);
        }
        const WorkResult result = worker.run(*unit);
        // The same unit done elsewhere, without what came before, is the same to the bit.
        const WorkResult again = other.run(*unit);
        ASSERT_TRUE(result.answer->orbit && again.answer->orbit);
        EXPECT_EQ(result.answer->orbit->beta, again.answer->orbit->beta);
        if (place > 0) beta.assign(result.answer->orbit->beta.begin(), result.answer->orbit->beta.end());
        queue.done(result);
    }
    EXPECT_TRUE(queue.finished());
}

TEST(SweepWorker, AUnitOfNoPatternIsMisuse) {
    const Scene scene = scene_of();
    SweepWorker worker(scene, {});
    EXPECT_THROW((void)worker.run({-1, -1, {}}), std::invalid_argument);
    EXPECT_THROW((void)worker.run({1'000'000, 0, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
