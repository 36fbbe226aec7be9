#include "nsma/price/relaxed_set.hpp"
#include "price/relaxed_program.hpp"

#include <random>

#include <gtest/gtest.h>

#include "time_reversed.hpp"

#include "nsma/set/admissible_set.hpp"
#include "nsma/set/reduction.hpp"
#include "search/orbit_program.hpp"
#include "price/relaxed_solver.hpp"

namespace {

using nsma::ConditionRow;
using nsma::Kernel;
using nsma::Objective;
using nsma::RelaxedSet;

std::vector<Kernel> live_kernels(int cells) {
    std::vector<Kernel> kernels;
    for (const auto& pattern : nsma::patterns_in(cells, {2, 4 * cells, 1, nsma::max_period_steps})) {
        Kernel kernel = nsma::exact_kernel(pattern);
        if (kernel.dimension() > 0) kernels.push_back(std::move(kernel));
    }
    return kernels;
}

Eigen::VectorXd drawn(int size, std::mt19937& random) {
    std::uniform_real_distribution<double> draw(-1, 1);
    Eigen::VectorXd values(size);
    for (auto& value : values) value = draw(random);
    return values;
}

TEST(RelaxedSet, RowsAreTheTipAndTheTension) {
    std::mt19937 random(4);
    for (const auto& kernel : live_kernels(5)) {
        const RelaxedSet set = nsma::relaxed_set(kernel, 1);
        const Eigen::VectorXd beta = drawn(kernel.dimension(), random);
        const Eigen::VectorXd tip = nsma::tip_history(kernel, beta);
        const Eigen::VectorXd values = set.rows * beta;
        EXPECT_NEAR(set.contact.dot(beta), tip[0], 1e-12);
        for (std::size_t i = 0; i < set.condition.size(); ++i) {
            for (const int n : set.condition[i].steps) {
                const double value = values[static_cast<Eigen::Index>(i)];
                if (set.condition[i].condition == ConditionRow::Condition::cond1) {
                    EXPECT_NEAR(value, tip[n], 1e-12);
                } else {  // lambda over Y S u/L is -2N b dt/u
                    const int sign = kernel.sign[static_cast<std::size_t>(n)];
                    EXPECT_NEAR(value, -10.0 * sign * beta[kernel.column(n)], 1e-12);
                }
            }
        }
    }
}

TEST(RelaxedSet, ProgramsHaveTheReportedObjective) {
    std::mt19937 random(5);
    for (const auto& kernel : live_kernels(4)) {
        const RelaxedSet set = nsma::relaxed_set(kernel, -1);
        const Eigen::VectorXd beta = drawn(kernel.dimension(), random);
        const Eigen::VectorXd reference = drawn(8, random);
        for (const auto objective : {Objective::least_shock, Objective::nearest, Objective::min_energy}) {
            const auto form = nsma::relaxed_program(set, objective, 2.5, {}, reference);
            const double expected = nsma::objective_of_waves(kernel, objective, beta, reference);
            EXPECT_NEAR(form.program.objective(form.point(beta)) * form.objective_unit, expected,
                        1e-12 * (1 + std::abs(expected)));
        }
        const auto force = nsma::relaxed_program(set, Objective::least_force, 2.5);
        EXPECT_NEAR(force.program.objective(force.point(beta)) * force.objective_unit,
                    nsma::objective_of_waves(kernel, Objective::least_force, beta), 1e-12 * beta.norm() * 8);
    }
}

// Two ways to the same interval: the reduced cone form and the parametric rows without presolve.
TEST(RelaxedSet, WithoutRelaxationItIsTheAdmissibleSet) {
    for (const int gap_sign : {1, -1}) {
        for (const auto& kernel : live_kernels(6)) {
            const auto set = nsma::admissible_set(nsma::reduce(nsma::conditions(kernel, gap_sign)));
            const auto interval = nsma::relaxed_interval(nsma::relaxed_set(kernel, gap_sign));
            ASSERT_FALSE(interval.failed);
            ASSERT_EQ(interval.empty, set.status == nsma::AdmissibleSet::Status::empty);
            if (interval.empty) continue;
            EXPECT_NEAR(interval.least, *set.interval().least, 1e-11 * interval.least);
            EXPECT_EQ(interval.unbounded, set.unbounded());
            if (!interval.unbounded) {
                EXPECT_NEAR(interval.greatest, *set.interval().greatest, 1e-9 * interval.greatest);
            }
        }
    }
}

TEST(RelaxedSet, MoreAllowedNeverNarrowsTheInterval) {
    for (const auto& kernel : live_kernels(5)) {
        const RelaxedSet set = nsma::relaxed_set(kernel, 1);
        for (const nsma::Relaxation unit : {nsma::Relaxation{1, 0, 0}, nsma::Relaxation{0, 1, 0},
                                            nsma::Relaxation{0, 0, 1}, nsma::Relaxation{1, 1, 1}}) {
            auto last = nsma::relaxed_interval(set);
            for (const double amount : {0.1, 0.3}) {
                const auto shift = set.shift({amount * unit.penetration, amount * unit.band, amount * unit.adhesion});
                auto next = nsma::relaxed_interval(set, shift);
                ASSERT_FALSE(next.failed);
                EXPECT_TRUE(last.empty || !next.empty);
                if (!last.empty) {
                    EXPECT_LE(next.least, last.least * (1 + 1e-10));
                    EXPECT_TRUE(next.unbounded || next.greatest >= last.greatest * (1 - 1e-9));
                }
                last = std::move(next);
            }
        }
    }
}

// Backwards in time every condition, the energy, the shock and the peak force are the same.
TEST(RelaxedSet, TimeReversalKeepsEverything) {
    std::mt19937 random(6);
    for (const auto& kernel : live_kernels(6)) {
        const Eigen::VectorXd beta = drawn(kernel.dimension(), random);
        const Eigen::VectorXd back = time_reversed(kernel, beta);
        const Eigen::VectorXd tip = nsma::tip_history(kernel, beta);
        const Eigen::VectorXd reversed = nsma::tip_history(kernel, back);
        const int r = kernel.pattern.free_steps;
        for (int n = 0; n <= r; ++n) EXPECT_NEAR(reversed[n], tip[r - n], 1e-12 * (1 + tip.norm()));
        EXPECT_LT((time_reversed(kernel, back) - beta).norm(), 1e-14);
        for (const auto objective : {Objective::least_shock, Objective::least_force, Objective::min_energy}) {
            const double here = nsma::objective_of_waves(kernel, objective, beta);
            EXPECT_NEAR(nsma::objective_of_waves(kernel, objective, back), here, 1e-12 * (1 + here));
        }
    }
}

// Random mixtures alone met worse optima of these patterns, which ones by rounding.
TEST(RelaxedSet, OptimaDoNotRestOnRandomStarts) {
    for (const auto& pattern : {nsma::Pattern{20, 56, 12}, nsma::Pattern{20, 50, 15}}) {
        const RelaxedSet set = nsma::relaxed_set(nsma::exact_kernel(pattern), 1);
        const nsma::Shift shift = set.shift({.band = 0.1, .adhesion = 0.1});
        const auto interval = nsma::relaxed_interval(set, shift);
        for (const Objective objective : {Objective::least_shock, Objective::least_force}) {
            nsma::RelaxedRequest request{
                .objective = objective, .level = 2 * interval.least, .shift = shift, .near = {}};
            const auto from_vertices = nsma::relaxed_optimum(set, interval, request);
            request.starts = 50;
            const auto from_many = nsma::relaxed_optimum(set, interval, request);
            ASSERT_TRUE(from_vertices && from_many);
            EXPECT_LE(from_vertices->objective, from_many->objective * (1 + 1e-9));  // two polishes
        }
    }
}

TEST(RelaxedSet, RefusesMisuse) {
    const Kernel kernel = nsma::exact_kernel({6, 16, 4});
    const RelaxedSet set = nsma::relaxed_set(kernel, 1);
    EXPECT_THROW((void)nsma::relaxed_set(nsma::exact_kernel({6, 1, 1}), 2), std::invalid_argument);
    EXPECT_THROW((void)nsma::relaxed_program(set, Objective::least_shock, 0.0), std::invalid_argument);
    nsma::Shift shift;
    shift.rows = Eigen::VectorXd::Zero(1);
    EXPECT_THROW((void)set.limits(shift), std::invalid_argument);
    EXPECT_THROW((void)nsma::relaxed_optimum(set, nsma::relaxed_interval(set), {}), std::invalid_argument);
}

}  // namespace
