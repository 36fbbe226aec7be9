// Levels with several local optima: found from many starts, and settled by the bound.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "nsma/program/level_points.hpp"
#include "nsma/program/orbit_program.hpp"
#include "nsma/program/orbit_solver.hpp"
#include "nsma/program/polish.hpp"

namespace {

using nsma::Objective;
using nsma::Pattern;

struct Case {
    Pattern pattern;
    double level;
    double gap;  ///< largest proved gap accepted; at 1e-6, the tolerance of agreement, it is global
};

class LocalOptima : public testing::TestWithParam<Case> {};

TEST_P(LocalOptima, AreFoundAndSettled) {
    const auto& [pattern, energy, gap] = GetParam();
    const auto problem = nsma::pattern_problem(pattern, 1);
    ASSERT_EQ(problem.verdict, nsma::Verdict::admissible);

    // Where descent alone comes to a KKT point, from admissible points on the level.
    const auto orbit = nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock, energy,
                                           *problem.interval.least);
    const nsma::LevelPoints points(problem.set, energy);
    std::vector<double> ends;
    for (int k = 0; k < 40; ++k) {
        const auto start = points.start(k);
        ASSERT_TRUE(start);
        const auto polished = nsma::polish(orbit.program, orbit.point(*start));
        if (!polished.feasible || !polished.stationary) continue;
        ends.push_back(polished.objective * orbit.objective_unit);
    }
    ASSERT_GE(ends.size(), 2U);
    std::sort(ends.begin(), ends.end());

    nsma::OrbitSolver solver;
    const auto answer = solver.solve(nsma::Bar{}, problem, {.level = energy, .reference = {}});
    ASSERT_EQ(answer.verdict, nsma::Verdict::admissible) << answer.reason;
    EXPECT_LE(nsma::replay(*answer.orbit, energy).violations.worst(), 1e-9);  // the acceptance of the project
    EXPECT_LE(*answer.objective_value, ends.front() * (1 + 1e-6));  // agreement tolerance
    EXPECT_GT(ends.back(), 1.01 * *answer.objective_value);         // another optimum, by more than rounding
    ASSERT_TRUE(answer.optimality && answer.optimality->lower_bound);
    EXPECT_LE(*answer.optimality->lower_bound, ends.front() * (1 + 1e-9));  // a bound is below every point
    EXPECT_LE(answer.optimality->gap, gap);
    EXPECT_EQ(answer.optimality->global, answer.optimality->gap <= 1e-6);
}

// Single runs of NLopt and Ipopt stop at 192 at the first, where the answer is 144.
INSTANTIATE_TEST_SUITE_P(Levels, LocalOptima,
                         testing::Values(Case{{6, 18, 6}, 36.0, 1e-6}, Case{{8, 22, 10}, 48.0, 1e-6}));
#ifndef __SANITIZE_ADDRESS__  // relaxations in dozens
INSTANTIATE_TEST_SUITE_P(HarderLevels, LocalOptima,
                         testing::Values(Case{{6, 22, 2}, 55.0, 0.1}, Case{{6, 20, 4}, 46.0, 0.1}));
#endif

}  // namespace
