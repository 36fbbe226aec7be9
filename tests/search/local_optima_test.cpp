// Levels with several local optima: the closed form is the best of what descent finds from many starts.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "numerics/polish.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"

namespace {

using nsma::Objective;
using nsma::Pattern;

struct Case {
    Pattern pattern;
    double level;
};

class LocalOptima : public testing::TestWithParam<Case> {};

TEST_P(LocalOptima, AreFoundAndSettled) {
    const auto& [pattern, energy] = GetParam();
    const auto problem = nsma::pattern_problem(pattern, 1);
    ASSERT_EQ(problem.verdict, nsma::Verdict::admissible);

    // Where descent alone comes to a KKT point, from admissible points on the level.
    const nsma::LevelPoints points(problem.set, energy);
    const auto target = nsma::make_orbit(nsma::Bar{}, problem.kernel, problem.set.reduction.beta(*points.start(5)));
    const Eigen::VectorXd reference = 0.7 * nsma::reference_window(target);  // not on the level: no distance is zero
    const auto orbit =
        nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::nearest, energy, reference);
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
    const auto answer =
        solver.solve(nsma::Bar{}, problem, {.level = energy, .objective = Objective::nearest, .reference = reference});
    ASSERT_EQ(answer.verdict, nsma::Verdict::admissible) << answer.reason;
    EXPECT_LE(nsma::replay(*answer.orbit, energy).violations.worst(), 1e-9);  // the acceptance of the project
    EXPECT_LE(*answer.objective_value, ends.front() * (1 + 1e-6));            // agreement tolerance
    EXPECT_GT(ends.back(), 1.01 * *answer.objective_value);                   // another optimum, by more than rounding
    ASSERT_TRUE(answer.optimality && answer.optimality->lower_bound);
    EXPECT_LE(*answer.optimality->lower_bound, ends.front() * (1 + 1e-9));  // a bound is below every point
    EXPECT_TRUE(answer.optimality->global);

    // Both solvers come to the best of them, asked from aside of it where their own starts end elsewhere.
    nsma::OrbitSolverOptions both;
    both.solvers = nsma::SolverChoice::both;
    const auto crossed = nsma::OrbitSolver(both).solve(
        nsma::Bar{}, problem, {.level = energy, .objective = Objective::nearest, .reference = reference});
    EXPECT_EQ(crossed.agreement, nsma::Agreement::agree) << crossed.reason;
    EXPECT_NEAR(*crossed.objective_value, *answer.objective_value,
                1e-12 * *answer.objective_value);  // the same formula
}

// Above half the greatest energy the sphere cuts the simplex into a piece for each vertex, each with an optimum of its
// own.
INSTANTIATE_TEST_SUITE_P(Levels, LocalOptima,
                         testing::Values(Case{{6, 16, 4}, 30.0}, Case{{12, 31, 9}, 60.0}, Case{{12, 32, 8}, 60.0},
                                         Case{{24, 64, 16}, 100.0}));

}  // namespace
