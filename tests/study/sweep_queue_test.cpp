#include "nsma/study/sweep_queue.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace nsma {
namespace {

OrbitSolverOptions asking(SolverChoice solvers) {
    OrbitSolverOptions options;
    options.solvers = solvers;
    return options;
}

Scene scene_of(Objective objective = Objective::least_shock) {
    Scene scene;
    scene.mesh.cells = 4;
    scene.patterns = PeriodSelection{{0.0, 4.0}, std::nullopt};
    scene.levels = {1.6, 6.0, 300.0};
    scene.objective = objective;
    return scene;
}

Eigen::VectorXd made_up_beta(long pattern, int place) {
    return Eigen::Vector2d(static_cast<double>(pattern), static_cast<double>(place));
}

/// A made-up result: every third pattern is admissible, every other place has an orbit.
WorkResult made_up(const WorkUnit& unit) {
    WorkResult result{unit.pattern, unit.place, std::nullopt, std::nullopt};
    if (unit.place < 0) {
        result.record.emplace().verdict = unit.pattern % 3 == 0 ? Verdict::admissible : Verdict::inadmissible;
    } else {
        result.answer.emplace().verdict = Verdict::above;
        if (unit.place % 2 == 0) result.answer->orbit.emplace().beta = made_up_beta(unit.pattern, unit.place);
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
    SweepQueue queue(scene, {}, SweepQueue::Order::scene);
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

// Five workers, of whom one in ten is lost with its unit. Levels of a strand, so many in a row, come in their order,
// each with the last orbit before it.
void expect_each_unit_once(const Scene& scene, const OrbitSolverOptions& options, int strand) {
    const bool extreme = is_extreme(scene.objective);
    const int last = extreme ? 1 : static_cast<int>(scene.levels.size());
    std::mt19937 random(5);
    SweepQueue queue(scene, options, SweepQueue::Order::longest_first);
    std::map<int, WorkUnit> held;
    std::set<Key> seen;
    while (!queue.finished()) {
        const int worker = static_cast<int>(random() % 5);
        const auto hand = held.find(worker);
        if (hand == held.end()) {
            const auto unit = queue.next(worker);
            if (!unit) continue;
            held[worker] = *unit;
            std::vector<double> before;
            const int first = unit->place < 1 ? unit->place : (unit->place - 1) / strand * strand + 1;
            for (int place = first; place < unit->place; ++place) {
                EXPECT_TRUE(seen.contains({unit->pattern, place}));
                if (place % 2 == 0) before = {static_cast<double>(unit->pattern), static_cast<double>(place)};
            }
            EXPECT_EQ(unit->before, before);
        } else if (random() % 10 == 0) {
            queue.lost(worker);
            held.erase(worker);
        } else {
            EXPECT_TRUE(seen.emplace(hand->second.pattern, hand->second.place).second);
            queue.done(made_up(hand->second));
            held.erase(worker);
        }
    }
    EXPECT_TRUE(held.empty());
    EXPECT_EQ(seen, all_units(scene, extreme ? 1 : 0, last));
    EXPECT_EQ(queue.done_count(), queue.total_count());
}

TEST(SweepQueue, ManyWorkersTakeEachUnitOnceThoughSomeAreLost) {
    for (const Objective objective : {Objective::least_shock, Objective::min_energy}) {
        expect_each_unit_once(scene_of(objective), {}, 1);
    }
}

TEST(SweepQueue, LevelsOfAStrandFollowOneAnother) {
    Scene scene = scene_of();
    scene.levels.resize(21);
    std::iota(scene.levels.begin(), scene.levels.end(), 1.0);
    for (const SolverChoice solvers : {SolverChoice::ipopt, SolverChoice::both}) expect_each_unit_once(scene, asking(solvers), 8);
    expect_each_unit_once(scene, asking(SolverChoice::nlopt), 1);
    scene.objective = Objective::nearest;
    expect_each_unit_once(scene, {}, 21);
}

TEST(SweepQueue, StrandsOfOnePatternAreSharedOut) {
    Scene scene = scene_of();
    scene.patterns = ListSelection{{{15, 1}}};
    scene.levels.resize(20);
    std::iota(scene.levels.begin(), scene.levels.end(), 1.0);
    SweepQueue queue(scene, asking(SolverChoice::both), SweepQueue::Order::longest_first);
    queue.done(made_up(*queue.next(0)));
    // The least-energy orbit and the first of each strand: levels 1, 9 and 17.
    std::set<int> places;
    for (int worker = 0; worker < 4; ++worker) places.insert(queue.next(worker)->place);
    EXPECT_EQ(places, (std::set<int>{0, 1, 9, 17}));
    EXPECT_FALSE(queue.next(4));
}

TEST(SweepQueue, LongestComesFirst) {
    const Scene scene = scene_of();
    const auto patterns = patterns_of(scene);
    SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
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
    Scene scene = scene_of();
    scene.levels.resize(12);
    const OrbitSolverOptions options = asking(SolverChoice::both);
    for (std::size_t stored = 0; stored < 120; ++stored) {
        SweepQueue whole(scene, options, SweepQueue::Order::scene);
        SweepQueue rest(scene, options, SweepQueue::Order::scene);
        std::set<Key> seen;
        std::map<Key, std::vector<double>> before;
        while (!whole.finished()) {
            const auto unit = *whole.next(0);
            whole.done(made_up(unit));
            before[{unit.pattern, unit.place}] = unit.before;
            if (seen.size() >= stored) continue;
            rest.done(made_up(unit));
            seen.emplace(unit.pattern, unit.place);
        }
        while (!rest.finished()) {
            const auto unit = *rest.next(0);
            rest.done(made_up(unit));
            EXPECT_TRUE(seen.emplace(unit.pattern, unit.place).second);
            EXPECT_EQ(unit.before, (before[{unit.pattern, unit.place}]));
        }
        EXPECT_EQ(seen, all_units(scene, 0, 12));
    }
}

TEST(SweepQueue, NearestFollowsThePatternFromLevelToLevel) {
    Scene scene = scene_of(Objective::nearest);
    scene.mesh.cells = 6;
    scene.patterns = ListSelection{{{23, 1}}};
    scene.levels = {1.6, 2.0, 2.5};
    SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
    SweepWorker worker(scene, {});
    SweepWorker other(scene, {});
    queue.done(worker.run(*queue.next(0)));
    queue.done(worker.run(*queue.next(0)));  // the least-energy orbit, which no level needs
    std::vector<double> beta;
    for (int place = 1; place <= 3; ++place) {
        const auto unit = queue.next(0);
        ASSERT_TRUE(unit);
        EXPECT_EQ(unit->place, place);
        EXPECT_EQ(unit->before, beta);
        EXPECT_FALSE(queue.next(1));  // it needs this one
        const WorkResult result = worker.run(*unit);
        // The same unit done elsewhere, without what came before, is the same to the bit.
        const WorkResult again = other.run(*unit);
        ASSERT_TRUE(result.answer->orbit && again.answer->orbit);
        EXPECT_EQ(result.answer->orbit->beta, again.answer->orbit->beta);
        beta.assign(result.answer->orbit->beta.begin(), result.answer->orbit->beta.end());
        queue.done(result);
    }
    EXPECT_TRUE(queue.finished());
}

}  // namespace
}  // namespace nsma
