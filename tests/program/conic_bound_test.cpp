#include "nsma/program/conic_bound.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "nsma/program/admissible_set.hpp"
#include "nsma/program/level_points.hpp"
#include "nsma/program/orbit_program.hpp"
#include "nsma/program/orbit_solver.hpp"
#include "nsma/program/polish.hpp"

namespace {

using nsma::Objective;

/// The least-shock program of (N, r, p) = (5m/2, 6m, 2m), m signed amplitudes on a simplex.
struct Simplex {
    Simplex(int size, double share)
        : problem(nsma::pattern_problem({5 * size / 2, 6 * size, 2 * size}, 1, {{}, false, {}})),
          level(share * *problem.interval.greatest),
          program(nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock, level,
                                      *problem.interval.least)) {}

    nsma::PatternProblem problem;
    double level;
    nsma::OrbitProgram program;
};

// With s = sum beta, q = sum beta^2 and R = n_T/m runs of the m amplitudes in a period, J/2N is at least
// 2 R q - 2 R sum_{i<j} beta_i beta_j = R (3 q - s^2), and that is attained by two neighbours where q >= s^2/2.
double least_shock_of_two(int size, double share) { return 2.0 * (2.5 * size) * 8.0 * (3.0 * share - 1.0); }

TEST(ProductBound, IsTightWhereTwoAmplitudesAreLeft) {
    for (const int size : {4, 8, 16, 32, 128}) {
        for (const double share : {0.5, 0.6, 0.8, 0.99}) {
            const Simplex simplex(size, share);
            const double bound = nsma::product_bound(simplex.program.program) * simplex.program.objective_unit;
            const double best = least_shock_of_two(size, share);
            EXPECT_NEAR(bound, best, 1e-10 * best) << size << ' ' << share;  // rounding of an eigenvalue
        }
    }
}

TEST(ProductBound, NeverExceedsAPointOfTheLevel) {
    for (const auto& pattern : {nsma::Pattern{6, 16, 4}, {6, 23, 1}, {20, 48, 16}, {12, 32, 8}, {6, 18, 6}}) {
        const auto problem = nsma::pattern_problem(pattern, 1);
        for (const double factor : {1.01, 1.5, 3.0}) {
            const double level = factor * *problem.interval.least;
            if (level > *problem.interval.greatest) continue;
            const auto program = nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock, level,
                                                     *problem.interval.least);
            const double bound = nsma::product_bound(program.program);
            const nsma::LevelPoints points(problem.set, level);
            for (int k = 0; k < 8; ++k) {
                EXPECT_LE(bound, program.program.objective(program.point(points.start(k).value())) * (1 + 1e-12));
            }
        }
    }
}

TEST(ConicBound, ClosesTheGapThatTheLagrangianLeaves) {
    const Simplex simplex(8, 0.3875);  // three amplitudes are left
    const double target = 88.0 / simplex.program.objective_unit;
    const auto bound = nsma::conic_bound(simplex.program.program, target);
    EXPECT_LE(bound.value, target * (1 + 1e-9));
    EXPECT_GE(bound.value, target * (1 - 1e-6));  // what counts as proved
    EXPECT_GE(bound.nodes, 1);
}

TEST(OrbitSolver, UntilProvedTakesTheLeastPointOfTheSphereWhereItIsAdmissible) {
    for (const int size : {4, 8, 32}) {
        const Simplex simplex(size, 1.2 / size);  // 1.2 E_min: every amplitude is positive
        nsma::OrbitSolverOptions options;
        options.solvers = nsma::SolverChoice::proof;
        nsma::OrbitSolver solver(options);
        const auto answer = solver.solve(nsma::Bar{}, simplex.problem, {.level = simplex.level, .reference = {}});
        EXPECT_EQ(answer.method, "sphere");
        ASSERT_TRUE(answer.optimality && answer.objective_value);
        EXPECT_TRUE(answer.optimality->global);
        const nsma::LevelPoints points(simplex.problem.set, simplex.level);
        for (int k = 0; k < 6; ++k) {
            const auto polished = nsma::polish(simplex.program.program, simplex.program.point(points.start(k).value()));
            EXPECT_LE(*answer.objective_value, polished.objective * simplex.program.objective_unit * (1 + 1e-12)) << size << ' ' << k;
        }
    }
}

TEST(OrbitSolver, UntilProvedIsTheBestAtEverySize) {
    for (const int size : {8, 32, 128}) {  // the last by Ipopt
        const Simplex simplex(size, 0.8);
        nsma::OrbitSolverOptions options;
        options.solvers = nsma::SolverChoice::proof;
        nsma::OrbitSolver solver(options);
        const auto answer = solver.solve(nsma::Bar{}, simplex.problem, {.level = simplex.level, .reference = {}});
        ASSERT_EQ(answer.verdict, nsma::Verdict::admissible) << answer.reason;
        const double best = least_shock_of_two(size, 0.8);
        EXPECT_NEAR(*answer.objective_value, best, 1e-9 * best);
        EXPECT_TRUE(answer.optimality && answer.optimality->global) << size;
        EXPECT_EQ(answer.agreement, nsma::Agreement::not_needed);
    }
}

}  // namespace
