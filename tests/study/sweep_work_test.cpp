#include "study/sweep/sweep_work.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace nsma {
namespace {

Scene one_pattern(Objective objective) {
    Scene scene;
    scene.mesh.cells = 8;
    scene.patterns = ListSelection{{{31, 1}}};
    scene.all_kinds = true;  // a free pattern, whose levels a solver decides
    scene.levels = {3.0, 4.0, 300.0};
    scene.objective = objective;
    return scene;
}

std::vector<double> beta_of(const WorkResult& result) {
    return {result.answer->orbit->beta.begin(), result.answer->orbit->beta.end()};
}

TEST(SweepWorker, IpoptStartsFromTheOrbitBefore) {
    const Scene scene = one_pattern(Objective::least_shock);
    OrbitSolverOptions options;
    options.solvers = SolverChoice::ipopt;
    SweepWorker worker(scene, options);
    const auto before = beta_of(worker.run(WorkUnit{0, 1, {}}));
    const WorkResult cold = worker.run(WorkUnit{0, 2, {}});
    const WorkResult warm = worker.run(WorkUnit{0, 2, before});
    const auto starts = [](const WorkResult& result) {
        std::set<int> all;
        for (const SolverRun& run : result.answer->solvers) all.insert(run.start);
        return all;
    };
    EXPECT_TRUE(starts(cold).contains(0));
    EXPECT_FALSE(starts(cold).contains(-1));
    EXPECT_TRUE(starts(warm).contains(-1));
    // The same unit elsewhere, without what came before, is the same to the bit.
    EXPECT_EQ(beta_of(SweepWorker(scene, options).run(WorkUnit{0, 2, before})), beta_of(warm));
}

TEST(SweepWorker, NearestStaysNearTheOrbitBefore) {
    Scene scene = one_pattern(Objective::nearest);
    scene.mesh.cells = 6;
    scene.patterns = ListSelection{{{16, 4}}};  // a simplex of four classes with one sign
    scene.levels = {20.0, 30.0};
    SweepWorker worker(scene, {});
    auto before = beta_of(worker.run(WorkUnit{0, 1, {}}));
    // From the least-energy orbit all vertices are as near; the one before was at another.
    std::reverse(before.begin(), before.end());
    const WorkResult from_before = worker.run(WorkUnit{0, 2, before});
    const WorkResult from_least = worker.run(WorkUnit{0, 2, {}});
    const auto distance = [&](const WorkResult& result) {
        const Eigen::Map<const Eigen::VectorXd> there(before.data(), static_cast<Eigen::Index>(before.size()));
        return (result.answer->orbit->beta - there).norm();
    };
    EXPECT_LT(distance(from_before), distance(from_least));
}

TEST(SweepWorker, AVerdictBringsTheLevelsOutsideItsInterval) {
    Scene scene = one_pattern(Objective::least_shock);
    scene.patterns = ListSelection{{{23, 9}, {31, 1}, {1, 1}}};
    scene.levels = {1e-3, 4.0, 1e6};
    SweepWorker worker(scene, {});
    const auto results = worker.run(std::vector<WorkUnit>{{0, -1, {}}, {1, -1, {}}, {2, -1, {}}});
    std::vector<std::pair<long, int>> got;
    for (const WorkResult& result : results) {
        got.emplace_back(result.pattern, result.place);
        if (result.place > 0) {
            EXPECT_EQ(result.answer->verdict, result.place == 1 ? Verdict::below : Verdict::above);
        }
    }
    EXPECT_EQ(got, (std::vector<std::pair<long, int>>{{0, -1}, {0, 1}, {0, 3}, {1, -1}, {1, 1}, {1, 3}, {2, -1}}));
    // Each is what the unit alone gives, but for its time.
    for (const WorkResult& result : results) {
        if (result.place < 0) continue;
        EXPECT_EQ(worker.run(WorkUnit{result.pattern, result.place, {}}).answer->reason, result.answer->reason);
    }
}

TEST(SweepWorker, AUnitOfNoPatternIsMisuse) {
    const Scene scene = one_pattern(Objective::least_shock);
    SweepWorker worker(scene, {});
    EXPECT_THROW((void)worker.run(WorkUnit{-1, -1, {}}), std::invalid_argument);
    EXPECT_THROW((void)worker.run(WorkUnit{1'000'000, 0, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
