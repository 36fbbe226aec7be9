#include "numerics/polish.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "../numerics/textbook.hpp"
#include "nsma/orbit/kernel.hpp"
#include "nsma/set/admissible_set.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using nsma::Multipliers;
using nsma::no_bound;
using nsma::polish;
using nsma::Polished;
using nsma::Program;

/// Left side of the KKT system of Multipliers, written out again.
VectorXd kkt(const Program& program, const VectorXd& x, const Multipliers& multipliers) {
    VectorXd balance = program.hessian * x + program.gradient;
    balance += program.equalities.transpose() * multipliers.equality;
    balance += program.inequalities.transpose() * multipliers.inequality;
    balance += multipliers.upper - multipliers.lower;
    balance.head(program.sphere_variables) += 2 * multipliers.sphere * x.head(program.sphere_variables);
    return balance;
}

void expect_kkt(const Program& program, const Polished& polished, double tolerance = 1e-9) {
    const auto& multipliers = polished.multipliers;
    EXPECT_LT(kkt(program, polished.x, multipliers).norm(),
              tolerance * (1 + program.objective_gradient(polished.x).norm()));
    for (Eigen::Index i = 0; i < multipliers.inequality.size(); ++i) {
        EXPECT_GE(multipliers.inequality[i], 0.0);
        const double slack = program.inequality_values[i] - program.inequalities.row(i).dot(polished.x);
        if (slack > 1e-9) {
            EXPECT_EQ(multipliers.inequality[i], 0.0) << "row " << i << " slack " << slack;
        }
    }
    for (Eigen::Index j = 0; j < program.variables(); ++j) {
        EXPECT_GE(multipliers.lower[j], 0.0);
        EXPECT_GE(multipliers.upper[j], 0.0);
        EXPECT_TRUE(multipliers.lower[j] == 0 || polished.x[j] <= program.lower[j] + 1e-9);
        EXPECT_TRUE(multipliers.upper[j] == 0 || polished.x[j] >= program.upper[j] - 1e-9);
    }
}

/// A feasible point near the optimum: moved along the set and brought back to the sphere.
VectorXd perturbed(const textbook::Case& item, const Vector3d& by) {
    VectorXd x = item.optimum + by;
    const auto& program = item.program;
    if (program.equalities.rows() > 0) {  // within the plane, about its point nearest to 0
        const VectorXd normal = program.equalities.row(0).transpose();
        const VectorXd centre = normal * program.equality_values[0] / normal.squaredNorm();
        VectorXd radial = x - centre;
        radial -= normal * normal.dot(radial) / normal.squaredNorm();
        return centre + radial.normalized() * std::sqrt(1 - centre.squaredNorm());
    }
    if (program.sphere_variables > 0) x.normalize();
    return x;
}

TEST(Polish, ReturnsFromAPerturbedOptimum) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> draw(-1, 1);
    int tried = 0;
    for (const auto& item : textbook::all()) {
        for (int trial = 0; trial < 40; ++trial) {
            const double size = std::pow(10.0, -1 - trial % 8);
            const VectorXd start = perturbed(item, size * Vector3d(draw(random), draw(random), draw(random)));
            if (item.program.violation(start) > 1e-12) continue;
            ++tried;
            const auto polished = polish(item.program, start);
            EXPECT_TRUE(polished.feasible) << item.name;
            EXPECT_TRUE(polished.stationary) << item.name;
            // It ends at a slope of 1e-12 (1 + |gradient|); the least curvature here is one.
            EXPECT_LT((polished.x - item.optimum).norm(), 6e-12) << item.name << " from " << size;
            EXPECT_NEAR(polished.objective, item.value, 1e-14 * 10) << item.name;
            EXPECT_LE(item.program.violation(polished.x), 1e-12);
            EXPECT_LE(polished.objective, item.program.objective(start) + 1e-15 * 10);
            expect_kkt(item.program, polished);
        }
    }
    EXPECT_GT(tried, 100);
}

TEST(Polish, MultipliersByHand) {
    // Cap at -y <= 1/2: y = 4 - 3 (1/2)/sqrt(3/4) = 4 - sqrt(3); x: 3 + 2 mu x = 0, mu = sqrt(3).
    const auto cap = textbook::linear_on_cap();
    const auto polished = polish(cap.program, cap.optimum);
    EXPECT_NEAR(polished.multipliers.inequality[0], 4 - std::sqrt(3.0), 1e-13);
    EXPECT_NEAR(polished.multipliers.sphere, std::sqrt(3.0), 1e-13);
    // Trust region: mu = 3/2 by construction.
    const auto region = textbook::trust_region();
    EXPECT_NEAR(polish(region.program, region.optimum).multipliers.sphere, 1.5, 1e-13);
    // Convex: x <= 1 carries 2 - nu, x + y <= 2 carries nu = -2(y - 1) = 0, z >= 1/2 carries 1.
    const auto convex = textbook::convex();
    const auto at = polish(convex.program, convex.optimum);
    EXPECT_NEAR(at.multipliers.inequality[0], 0, 1e-13);
    EXPECT_NEAR(at.multipliers.upper[0], 2, 1e-13);
    EXPECT_NEAR(at.multipliers.lower[2], 1, 1e-13);
}

TEST(Polish, MultipliersAreDerivativesOfTheOptimalValue) {
    const double h = 1e-5;  // truncation of central differences 1e-10, rounding 1e-11
    const auto value = [](double bound) {
        const auto item = textbook::linear_on_cap(bound);
        return polish(item.program, perturbed(item, {-0.01, 0.02, 0.01})).objective;
    };
    const auto cap = textbook::linear_on_cap();
    EXPECT_NEAR(-(value(0.5 + h) - value(0.5 - h)) / (2 * h),
                polish(cap.program, cap.optimum).multipliers.inequality[0], 1e-8);
    // The plane x + y + z = s: L = f + nu (row - s), so df/ds = -nu.
    const auto on_plane = [](double s) {
        auto program = textbook::circle().program;
        program.equality_values[0] = s;
        // Exact point of the circle off its lowest: centre s/3, radius sqrt(1 - s^2/3).
        const Vector3d centre = Vector3d::Constant(s / 3);
        const Vector3d aside = Vector3d(-2, 1.2, 0.8).normalized();
        return polish(program, centre + std::sqrt(1 - s * s / 3) * aside).objective;
    };
    const auto circle = textbook::circle();
    EXPECT_NEAR(-(on_plane(1 + h) - on_plane(1 - h)) / (2 * h),
                polish(circle.program, circle.optimum).multipliers.equality[0], 1e-8);
}

TEST(Polish, NeverRaisesTheObjectiveAndStaysFeasible) {
    std::mt19937 random(14);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 100; ++trial) {
        // Random quadratics on a circle, from anywhere on it.
        auto item = textbook::circle();
        Eigen::Matrix3d hessian =
            Eigen::Matrix3d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return normal(random); });
        hessian = (hessian + hessian.transpose()).eval();
        item.program.hessian = hessian.sparseView();
        const VectorXd start = perturbed(item, Vector3d(normal(random), normal(random), normal(random)));
        const auto polished = polish(item.program, start);
        EXPECT_TRUE(polished.feasible);
        EXPECT_LE(polished.objective, item.program.objective(start) + 1e-13);
        EXPECT_NEAR(polished.objective, item.program.objective(polished.x), 1e-14 * 10);
        if (polished.stationary) expect_kkt(item.program, polished);
        // The whole circle by sampling: nothing is below the proven bound.
        double best = no_bound;
        for (int i = 0; i < 4000; ++i) {
            const double t = 2 * M_PI * i / 4000;
            const Vector3d e = Vector3d(-2, 1, 1) / std::sqrt(6.0);
            const Vector3d f = Vector3d(0, 1, -1) / std::sqrt(2.0);
            const Vector3d x = Vector3d::Constant(1.0 / 3) + std::sqrt(2.0 / 3) * (std::cos(t) * e + std::sin(t) * f);
            best = std::min(best, item.program.objective(x));
        }
        EXPECT_LE(polished.lower_bound, best + 1e-12);
        if (polished.stationary) {
            EXPECT_GT(polished.lower_bound, -no_bound);
        }
    }
}

TEST(Polish, LowerBoundIsTightAtAGlobalOptimum) {
    for (const auto& item : {textbook::linear_on_sphere(), textbook::trust_region(), textbook::convex()}) {
        const auto polished = polish(item.program, item.optimum);
        EXPECT_LE(polished.lower_bound, item.value + 1e-14 * 10) << item.name;
        EXPECT_GT(polished.lower_bound, item.value - 1e-9) << item.name;  // stationarity slip
    }
}

TEST(Polish, DegenerateVertexIsKept) {
    const auto item = textbook::degenerate_vertex();
    const auto polished = polish(item.program, item.optimum);
    EXPECT_TRUE(polished.feasible);
    EXPECT_LT((polished.x - item.optimum).norm(), 1e-12);
    EXPECT_LE(polished.lower_bound, item.value + 1e-12);
    if (polished.stationary) expect_kkt(item.program, polished);
}

TEST(Polish, OrbitProgramsDescendToKktPoints) {
    // Starts on the level of real patterns; the level bound is checked against every start's value.
    for (const auto& pattern : {nsma::Pattern{6, 16, 4}, {6, 23, 1}, {20, 48, 16}, {12, 32, 8}}) {
        const auto kernel = nsma::exact_kernel(pattern);
        const auto set = nsma::admissible_set(nsma::reduce(nsma::conditions(kernel, 1)));
        const double level = 1.5 * *set.interval().least;
        const auto program = nsma::orbit_program(set.reduction, kernel, nsma::Objective::least_shock, level);
        const nsma::LevelPoints points(set, level);
        double best = no_bound;
        double bound = -no_bound;
        for (int k = 0; k < 6; ++k) {
            const VectorXd start = program.point(*points.start(k));
            const auto polished = polish(program.program, start);
            EXPECT_TRUE(polished.feasible);
            EXPECT_LE(polished.objective, program.program.objective(start) * (1 + 1e-12));
            if (polished.stationary) expect_kkt(program.program, polished, 1e-8);
            best = std::min(best, polished.objective);
            bound = std::max(bound, polished.lower_bound);
        }
        EXPECT_LE(bound, best * (1 + 1e-9));
    }
}

TEST(Polish, LeavesASaddle) {
    // Amplitudes (a, b, a, 0): stationary by symmetry; two neighbours are better.
    const auto problem = nsma::pattern_problem({10, 24, 8}, 1);
    const double level = 0.8 * *problem.interval.greatest;
    const auto program =
        nsma::orbit_program(problem.set.reduction, problem.kernel, nsma::Objective::least_shock, level);
    const double a = (4 - std::sqrt(16 - 24 * (1 - 0.8))) / 12;  // 2 a^2 + (1 - 2 a)^2 = 0.8
    VectorXd gamma = VectorXd::Zero(4);
    for (const auto& vertex : problem.set.vertices) {
        Eigen::Index column = 0;
        vertex.cwiseAbs().maxCoeff(&column);
        if (column < 3) gamma += (column == 1 ? 1 - 2 * a : a) * vertex;
    }
    const auto polished = polish(program.program, program.point(gamma));
    EXPECT_TRUE(polished.stationary);
    EXPECT_NEAR(polished.objective * program.objective_unit, 2 * 10 * 8 * (3 * 0.8 - 1),
                1e-9 * 224);  // two neighbours, 8 runs a period
}

TEST(Polish, ComesToTheOptimumCloseToTheLeastEnergy) {
    // The sphere cuts COND2 in a small circle, on which the objective shows no progress beyond its rounding.
    for (const int size : {8, 16, 32}) {
        for (const int sign : {1, -1}) {
            const nsma::Pattern pattern = sign > 0 ? nsma::Pattern{5 * size / 2, 6 * size, 2 * size}
                                                   : nsma::Pattern{5 * size / 2, 4 * size, 3 * size};
            const auto problem = nsma::pattern_problem(pattern, sign);
            for (const double above : {1e-10, 1e-9, 1e-8, 1e-6, 1e-3}) {
                const double level = *problem.interval.least * (1 + above);
                const auto program =
                    nsma::orbit_program(problem.set.reduction, problem.kernel, nsma::Objective::least_shock, level);
                const nsma::LevelPoints points(problem.set, level);
                const auto polished = polish(program.program, program.point(*points.start(0)));
                EXPECT_TRUE(polished.stationary) << size << ' ' << sign << ' ' << above;
                EXPECT_GE(polished.lower_bound, polished.objective * (1 - 1e-6)) << size << ' ' << sign << ' ' << above;
            }
        }
    }
}

TEST(Polish, NonsenseStartIsNotFeasible) {
    const auto item = textbook::trust_region();
    EXPECT_FALSE(polish(item.program, Vector3d(0, std::nan(""), 1)).feasible);
    EXPECT_FALSE(polish(item.program, VectorXd::Zero(2)).feasible);
}

}  // namespace
