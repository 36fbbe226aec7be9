#include "nsma/program/lifted_program.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "nsma/program/level_points.hpp"
#include "nsma/program/orbit_solver.hpp"

namespace nsma {
namespace {

struct Made {
    PatternProblem problem;
    OrbitProgram condensed;
    LiftedProgram lifted;
    Eigen::VectorXd start;
};

Made made(const Pattern& pattern, Objective objective = Objective::least_shock) {
    PatternOptions options;
    options.prove = false;
    Made result;
    result.problem = pattern_problem(pattern, 1, options);
    const double level = std::sqrt(*result.problem.interval.least * *result.problem.interval.greatest);
    const Reduction& reduction = result.problem.set.reduction;
    result.condensed = orbit_program(reduction, result.problem.kernel, objective, level, 0.0);
    result.lifted = lifted_program(result.condensed, reduction, result.problem.kernel);
    result.start = result.condensed.point(*LevelPoints(result.problem.set, level).start(1));
    return result;
}

TEST(LiftedProgram, HasTheSamePointsWithTheSameViolations) {
    for (const Pattern& pattern : {Pattern{6, 23, 1}, Pattern{6, 20, 4}, Pattern{12, 44, 4}, Pattern{6, 16, 4}}) {
        for (const Objective objective : {Objective::least_shock, Objective::least_force}) {
            const Made m = made(pattern, objective);
            validate(m.lifted.program);
            const Eigen::VectorXd x = m.lifted.point(m.start);
            EXPECT_EQ(x.head(m.start.size()), m.start);
            EXPECT_LE(m.lifted.program.violation(x), 1e-12);  // a feasible start, sums of a few terms
            // The new unknowns are the rows of the condensed program, unscaled.
            const Reduction& reduction = m.problem.set.reduction;
            const Eigen::VectorXd rows = reduction.rows.cast<double>() * m.start.head(reduction.variables());
            EXPECT_LE((rows - x.tail(rows.size())).norm(), 1e-12 * (1 + rows.norm()));
            EXPECT_NEAR(m.lifted.program.objective(x), m.condensed.program.objective(m.start), 1e-12);
        }
    }
}

TEST(LiftedProgram, HasTheSameOptimum) {
    for (const Pattern& pattern : {Pattern{6, 23, 1}, Pattern{8, 30, 2}}) {
        const Made m = made(pattern);
        IpoptSolver ipopt;
        const SolverOutcome condensed = ipopt.solve(m.condensed.program, m.start);
        const SolverOutcome lifted = ipopt.solve(m.lifted.program, m.lifted.point(m.start));
        EXPECT_LE(m.lifted.program.violation(lifted.x), 1e-7) << lifted.status;
        EXPECT_LE(m.condensed.program.violation(lifted.x.head(m.start.size())), 1e-7);
        // Local optima may differ, so only what both claim to be is compared: no worse than the start.
        EXPECT_LE(m.lifted.program.objective(lifted.x), m.condensed.program.objective(m.start) + 1e-7) << lifted.status;
        EXPECT_LE(m.condensed.program.objective(condensed.x), m.condensed.program.objective(m.start) + 1e-7);
    }
}

TEST(LiftedProgram, NonzerosGrowAsThePeriod) {
    for (const int cells : {12, 24, 48}) {
        const Made m = made({cells, 4 * cells - 1, 1});
        const auto& program = m.lifted.program;
        EXPECT_LE(program.equalities.nonZeros() + program.inequalities.nonZeros(),
                  4 * cells + 4 * m.problem.set.reduction.rows.rows());
        EXPECT_EQ(prefers_lifted(m.condensed, m.problem.kernel), cells > 24) << cells;
    }
}

TEST(LiftedProgram, AnotherReductionIsMisuse) {
    const Made m = made({6, 23, 1});
    const Made other = made({6, 16, 4});
    EXPECT_THROW((void)lifted_program(other.condensed, m.problem.set.reduction, m.problem.kernel), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
