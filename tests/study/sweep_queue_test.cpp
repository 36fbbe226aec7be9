#include "study/sweep/sweep_queue.hpp"

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
        if (unit.pattern % 3 == 0) result.record->kind = PatternKind::contact;
    } else {
        result.answer.emplace().verdict = Verdict::above;
        if (unit.place % 2 == 0) result.answer->orbit.emplace().beta = made_up_beta(unit.pattern, unit.place);
    }
    return result;
}

/// A worker that only makes its results up.
std::vector<WorkResult> made_up(const std::vector<WorkUnit>& units) {
    std::vector<WorkResult> results;
    for (const WorkUnit& unit : units) results.push_back(made_up(unit));
    return results;
}

void all_done(SweepQueue& queue, const std::vector<WorkResult>& results) {
    for (const WorkResult& result : results) queue.done(result);
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
        const auto units = queue.next(0);
        ASSERT_EQ(units.size(), 1u);
        seen.emplace_back(units[0].pattern, units[0].place);
        all_done(queue, made_up(units));
    }
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(std::set<Key>(seen.begin(), seen.end()), all_units(scene, 0, 3));
    EXPECT_EQ(queue.work_done(), queue.work_total());
    EXPECT_TRUE(queue.next(0).empty());
}

TEST(SweepQueue, VerdictsGoInAboutEqualWork) {
    Scene scene = scene_of();
    scene.mesh.cells = 40;
    const auto patterns = patterns_of(scene);
    SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
    std::set<long> seen;
    for (int worker = 0; seen.size() < patterns.size(); ++worker) {
        const auto units = queue.next(worker);
        ASSERT_FALSE(units.empty());
        double work = 0;
        for (const WorkUnit& unit : units) {
            const Pattern& pattern = patterns[static_cast<std::size_t>(unit.pattern)];
            work += 1000 + static_cast<double>(kernel_dimension(pattern)) * pattern.period_steps();
            EXPECT_TRUE(seen.insert(unit.pattern).second);
        }
        // A batch ends with the pattern that fills it.
        EXPECT_TRUE(work >= 20'000 || seen.size() == patterns.size());
        EXPECT_LT(work, 20'000 + 1000 + 80 * 160);
    }
    EXPECT_TRUE(queue.next(-1).empty());
}

// Five workers, of whom one in ten is lost with its unit. Levels of a strand, so many in a row, come in their order,
// each with the last orbit before it.
void expect_each_unit_once(const Scene& scene, const OrbitSolverOptions& options, int strand) {
    const bool extreme = is_extreme(scene.objective);
    const int last = extreme ? 1 : static_cast<int>(scene.levels.size());
    std::mt19937 random(5);
    SweepQueue queue(scene, options, SweepQueue::Order::longest_first);
    std::map<int, std::vector<WorkUnit>> held;
    std::set<Key> seen;
    for (int turn = 0; turn < 1'000'000 && !queue.finished(); ++turn) {
        const int worker = static_cast<int>(random() % 5);
        const auto hand = held.find(worker);
        if (hand == held.end()) {
            const auto units = queue.next(worker);
            if (units.empty()) continue;
            held[worker] = units;
            for (const WorkUnit& unit : units) {
                std::vector<double> before;
                const int first = unit.place < 1 ? unit.place : (unit.place - 1) / strand * strand + 1;
                for (int place = first; place < unit.place; ++place) {
                    EXPECT_TRUE(seen.contains({unit.pattern, place}));
                    if (place % 2 == 0) before = {static_cast<double>(unit.pattern), static_cast<double>(place)};
                }
                EXPECT_EQ(unit.before, before);
            }
        } else if (random() % 10 == 0) {
            queue.lost(worker);
            held.erase(worker);
        } else {
            for (const WorkUnit& unit : hand->second) EXPECT_TRUE(seen.emplace(unit.pattern, unit.place).second);
            all_done(queue, made_up(hand->second));
            held.erase(worker);
        }
    }
    EXPECT_TRUE(queue.finished());
    EXPECT_TRUE(held.empty());
    EXPECT_EQ(seen, all_units(scene, extreme ? 1 : 0, last));
    EXPECT_EQ(queue.work_done(), queue.work_total());
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
    for (const SolverChoice solvers : {SolverChoice::ipopt, SolverChoice::both})
        expect_each_unit_once(scene, asking(solvers), 8);
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
    all_done(queue, made_up(queue.next(0)));
    // The least-energy orbit and the first of each strand: levels 1, 9 and 17.
    std::set<int> places;
    for (int worker = 0; worker < 4; ++worker) places.insert(queue.next(worker).at(0).place);
    EXPECT_EQ(places, (std::set<int>{0, 1, 9, 17}));
    EXPECT_TRUE(queue.next(4).empty());
}

TEST(SweepQueue, LongestComesFirst) {
    const Scene scene = scene_of();
    const auto patterns = patterns_of(scene);
    SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
    double last = 1e300;
    std::size_t handed = 0;
    for (int worker = 0; handed < patterns.size(); ++worker) {
        const auto units = queue.next(worker);
        ASSERT_FALSE(units.empty());
        for (const WorkUnit& unit : units) {
            const Pattern& pattern = patterns[static_cast<std::size_t>(unit.pattern)];
            const double work = static_cast<double>(kernel_dimension(pattern)) * pattern.period_steps();
            EXPECT_LE(work, last);
            last = work;
            ++handed;
        }
    }
}

TEST(SweepQueue, LevelsThatComeWithAVerdictAreNotHandedOut) {
    Scene scene = scene_of();
    scene.patterns = ListSelection{{{15, 1}}};
    scene.levels.resize(20);
    for (const SolverChoice solvers : {SolverChoice::both, SolverChoice::proof}) {
        SweepQueue queue(scene, asking(solvers), SweepQueue::Order::scene);
        all_done(queue, made_up(queue.next(0)));
        // Outside the interval: the first three, and from the twelfth on.
        std::set<int> places;
        for (int place = 1; place <= 20; ++place) {
            if (place > 3 && place < 12) continue;
            queue.done(made_up(WorkUnit{0, place, {}}));
            places.insert(place);
        }
        while (!queue.finished()) {
            const auto units = queue.next(0);
            ASSERT_EQ(units.size(), 1u);
            EXPECT_TRUE(places.insert(units[0].place).second) << units[0].place;
            all_done(queue, made_up(units));
        }
        EXPECT_EQ(places.size(), 21u);
        EXPECT_EQ(queue.work_done(), queue.work_total());
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
        // A message is stored as a whole. Verdicts bring two levels with them, which have no orbit.
        const auto with_brought = [](std::vector<WorkUnit> units) {
            for (std::size_t i = 0; i < units.size(); ++i) {
                if (units[i].place >= 0 || units[i].pattern % 3 != 0) continue;
                for (const int place : {1, 11}) units.push_back({units[i].pattern, place, {}});
            }
            return units;
        };
        while (!whole.finished()) {
            const auto units = with_brought(whole.next(0));
            const bool kept = seen.size() < stored;
            all_done(whole, made_up(units));
            if (kept) all_done(rest, made_up(units));
            for (const WorkUnit& unit : units) {
                before[{unit.pattern, unit.place}] = unit.before;
                if (kept) seen.emplace(unit.pattern, unit.place);
            }
        }
        for (int turn = 0; turn < 1'000 && !rest.finished(); ++turn) {
            const auto units = with_brought(rest.next(0));
            all_done(rest, made_up(units));
            for (const WorkUnit& unit : units) {
                EXPECT_TRUE(seen.emplace(unit.pattern, unit.place).second);
                EXPECT_EQ(unit.before, (before[{unit.pattern, unit.place}]));
            }
        }
        EXPECT_TRUE(rest.finished());
        EXPECT_EQ(seen, all_units(scene, 0, 12));
    }
}

// The true results of a scene, in a queue's order; what `seen` makes of the shares of work done.
template <class Seen>
void run_whole(const Scene& scene, const OrbitSolverOptions& options, SweepQueue::Order order, const Seen& seen) {
    SweepQueue queue(scene, options, order);
    SweepWorker worker(scene, options);
    const std::int64_t total = queue.work_total();
    std::int64_t before = 0;
    while (!queue.finished()) {
        for (const WorkResult& result : worker.run(queue.next(0))) {
            queue.done(result);
            EXPECT_GE(queue.work_done(), before);
            EXPECT_LE(queue.work_done(), total);
            EXPECT_EQ(queue.work_total(), total);
            seen(result, queue.work_done() - before);
            before = queue.work_done();
        }
    }
    EXPECT_EQ(queue.work_done(), total);
}

TEST(SweepQueue, WorkGrowsToItsTotal) {
    for (const Objective objective : {Objective::least_shock, Objective::max_energy}) {
        for (const double gap : {1.0, -1.0}) {
            Scene scene = scene_of(objective);
            scene.bar.gap = gap;
            scene.all_kinds = true;
            for (const auto order : {SweepQueue::Order::scene, SweepQueue::Order::longest_first})
                run_whole(scene, {}, order, [](const WorkResult&, std::int64_t) {});
        }
    }
}

TEST(SweepQueue, WorkGoesWhereTimeGoes) {
    Scene scene = scene_of();
    scene.mesh.cells = 6;
    scene.all_kinds = true;
    scene.levels = {1.6, 6.0, 30.0, 300.0};
    std::int64_t trivial = 0, solved = 0, least = 1'000'000, outside = 0;
    run_whole(scene, {}, SweepQueue::Order::scene, [&](const WorkResult& result, std::int64_t work) {
        if (result.record && result.record->verdict == Verdict::trivial) trivial = std::max(trivial, work);
        if (!result.answer || result.place == 0) return;
        const OrbitAnswer& answer = *result.answer;
        if (answer.verdict != Verdict::admissible) outside = std::max(outside, work);
        if (answer.kind != PatternKind::free || answer.solvers.empty()) return;
        solved += work;
        least = std::min(least, work);
    });
    EXPECT_GT(trivial, 0);
    EXPECT_GT(solved, 0);
    EXPECT_GT(least, 20 * trivial);
    EXPECT_GT(least, 20 * outside);

    const auto inside = [&scene](SolverChoice solvers) { return SweepCost(scene, asking(solvers))({6, 16, 4}).inside; };
    EXPECT_GT(inside(SolverChoice::both), inside(SolverChoice::nlopt));
    EXPECT_GT(inside(SolverChoice::nlopt), inside(SolverChoice::proof));
}

TEST(SweepQueue, NearestFollowsThePatternFromLevelToLevel) {
    Scene scene = scene_of(Objective::nearest);
    scene.mesh.cells = 6;
    scene.patterns = ListSelection{{{16, 4}}};
    scene.levels = {12.0, 20.0, 30.0};
    SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
    SweepWorker worker(scene, {});
    SweepWorker other(scene, {});
    all_done(queue, worker.run(queue.next(0)));
    all_done(queue, worker.run(queue.next(0)));  // the least-energy orbit, which no level needs
    std::vector<double> beta;
    for (int place = 1; place <= 3; ++place) {
        const auto units = queue.next(0);
        ASSERT_EQ(units.size(), 1u);
        EXPECT_EQ(units[0].place, place);
        EXPECT_EQ(units[0].before, beta);
        EXPECT_TRUE(queue.next(1).empty());  // it needs this one
        const WorkResult result = worker.run(units[0]);
        // The same unit done elsewhere, without what came before, is the same to the bit.
        const WorkResult again = other.run(units[0]);
        ASSERT_TRUE(result.answer->orbit && again.answer->orbit);
        EXPECT_EQ(result.answer->orbit->beta, again.answer->orbit->beta);
        beta.assign(result.answer->orbit->beta.begin(), result.answer->orbit->beta.end());
        queue.done(result);
    }
    EXPECT_TRUE(queue.finished());
}

}  // namespace
}  // namespace nsma
