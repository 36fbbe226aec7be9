#include "nsma/study/sweep_work.hpp"

#include <set>

#include <gtest/gtest.h>

namespace nsma {
namespace {

Scene one_pattern(Objective objective) {
    Scene scene;
    scene.mesh.cells = 8;
    scene.patterns = ListSelection{{{31, 1}}};
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
    options.bound_nodes = 0;
    SweepWorker worker(scene, options);
    const auto before = beta_of(worker.run({0, 1, {}}));
    const WorkResult cold = worker.run({0, 2, {}});
    const WorkResult warm = worker.run({0, 2, before});
    const auto starts = [](const WorkResult& result) {
        std::set<int> all;
        for (const SolverRun& run : result.answer->solvers) all.insert(run.start);
        return all;
    };
    EXPECT_TRUE(starts(cold).contains(0));
    EXPECT_FALSE(starts(cold).contains(-1));
    EXPECT_TRUE(starts(warm).contains(-1));
    // The same unit elsewhere, without what came before, is the same to the bit.
    EXPECT_EQ(beta_of(SweepWorker(scene, options).run({0, 2, before})), beta_of(warm));
}

TEST(SweepWorker, NearestStaysNearTheOrbitBefore) {
    const Scene scene = one_pattern(Objective::nearest);
    SweepWorker worker(scene, {});
    const auto before = beta_of(worker.run({0, 1, {}}));
    const WorkResult from_before = worker.run({0, 2, before});
    const WorkResult from_least = worker.run({0, 2, {}});
    const auto distance = [&](const WorkResult& result) {
        return (result.answer->orbit->beta - Eigen::Map<const Eigen::VectorXd>(before.data(), static_cast<Eigen::Index>(before.size()))).norm();
    };
    EXPECT_LT(distance(from_before), distance(from_least));
}

TEST(SweepWorker, AUnitOfNoPatternIsMisuse) {
    const Scene scene = one_pattern(Objective::least_shock);
    SweepWorker worker(scene, {});
    EXPECT_THROW((void)worker.run({-1, -1, {}}), std::invalid_argument);
    EXPECT_THROW((void)worker.run({1'000'000, 0, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
