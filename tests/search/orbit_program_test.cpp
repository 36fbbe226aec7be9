#include "search/orbit_program.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "wave/wave_queue.hpp"
#include "nsma/orbit/orbit.hpp"

namespace {

using Eigen::VectorXd;
using nsma::Bar;
using nsma::conditions;
using nsma::exact_kernel;
using nsma::Kernel;
using nsma::Objective;
using nsma::orbit_program;
using nsma::Pattern;
using nsma::reduce;
using nsma::Reduction;

/// The first mode, many free classes, a pattern with forced zeros, one with 2N < n_T, a prestressed one.
struct Case {
    Pattern pattern;
    int gap_sign;
};
const Case cases[] = {{{6, 16, 4}, 1}, {{6, 23, 1}, 1}, {{20, 48, 16}, 1}, {{6, 12, 12}, 1},
                      {{5, 20, 4}, 1}, {{4, 8, 4}, -1}, {{6, 23, 1}, 0}};

const Bar steel{0.5, 210e9, 7850.0, 1e-4, 1e-4};

VectorXd random_gamma(const Reduction& reduction, std::mt19937& random) {
    std::normal_distribution<double> normal;
    VectorXd gamma(reduction.variables());
    for (Eigen::Index j = 0; j < gamma.size(); ++j) {
        gamma[j] = normal(random);
        if (reduction.bounded) gamma[j] = std::abs(gamma[j]);
    }
    return gamma;
}

Bar bar_of(int gap_sign) {
    Bar bar = steel;
    bar.gap *= gap_sign;
    return bar;
}

/// b_0..b_{n_T} [m/s] of the labelled schedule, marched as a queue from Q0.
VectorXd marched_waves(const nsma::Orbit& orbit) {
    const Pattern& pattern = orbit.kernel.pattern;
    nsma::WaveQueue queue(orbit.bar, orbit.mesh(), nsma::initial_state(orbit));
    VectorXd waves(pattern.period_steps() + 1);
    for (int n = 0; n <= pattern.period_steps(); ++n) {
        waves[n] = queue.arriving();
        if (n < pattern.free_steps) {
            queue.step_free();
        } else {
            queue.step_contact();
        }
    }
    return waves;
}

// Sums of up to 64 squares in another order; unit conversions are a few more products.
constexpr double rounding = 1e-11;

TEST(OrbitProgram, ObjectivesEqualTheirDefinitionsInMarchedWaves) {
    std::mt19937 random(9);
    for (const auto& [pattern, gap_sign] : cases) {
        const Kernel kernel = exact_kernel(pattern);
        const Reduction reduction = reduce(conditions(kernel, gap_sign));
        if (reduction.variables() == 0) continue;
        const Bar bar = bar_of(gap_sign);
        const double cell_mass = bar.density * bar.area * bar.length / pattern.cells;
        for (int trial = 0; trial < 10; ++trial) {
            const VectorXd beta = reduction.beta(random_gamma(reduction, random));
            const auto orbit = nsma::make_orbit(bar, kernel, beta);
            const VectorXd waves = marched_waves(orbit);
            double shock = 0;
            double peak = 0;
            for (int n = 0; n < pattern.period_steps(); ++n) {
                shock += cell_mass * std::pow(waves[n + 1] - waves[n], 2) / bar.energy_unit();
                if (n < pattern.free_steps) continue;
                peak = std::max(peak, 2 * bar.impedance() * bar.area * std::abs(waves[n]) / bar.force_unit());
            }
            EXPECT_NEAR(objective_of_waves(kernel, Objective::least_shock, beta), shock, rounding * shock);
            EXPECT_NEAR(objective_of_waves(kernel, Objective::least_force, beta), peak, rounding * (1 + peak));
            EXPECT_NEAR(peak, nsma::contact_force(orbit).cwiseAbs().maxCoeff() / bar.force_unit(),
                        rounding * (1 + peak));
            const double energy = nsma::energy_ratio(orbit);
            EXPECT_NEAR(objective_of_waves(kernel, Objective::min_energy, beta), energy, rounding * energy);
            EXPECT_NEAR(objective_of_waves(kernel, Objective::max_energy, beta), energy, rounding * energy);

            // nearest: the energy of the difference of the two states, which is a state itself.
            const VectorXd other = reduction.beta(random_gamma(reduction, random));
            const nsma::State difference =
                nsma::initial_state(orbit) - nsma::initial_state(nsma::make_orbit(bar, kernel, other));
            const double distance = nsma::energy(bar, orbit.mesh(), difference) / bar.energy_unit();
            EXPECT_NEAR(objective_of_waves(kernel, Objective::nearest, beta, nsma::wave_basis(kernel) * other),
                        distance, rounding * (1 + distance));
        }
    }
}

TEST(OrbitProgram, ProgramValueIsTheObjectiveOfTheWaves) {
    std::mt19937 random(10);
    for (const auto& [pattern, gap_sign] : cases) {
        const Kernel kernel = exact_kernel(pattern);
        const Reduction reduction = reduce(conditions(kernel, gap_sign));
        if (reduction.variables() == 0) continue;
        for (const Objective objective : {Objective::least_shock, Objective::nearest, Objective::least_force}) {
            const double level = 3.7;
            const VectorXd reference = nsma::wave_basis(kernel) * reduction.beta(random_gamma(reduction, random));
            const auto program = orbit_program(reduction, kernel, objective, level, reference);
            ASSERT_NO_THROW(validate(program.program));
            for (int trial = 0; trial < 10; ++trial) {
                VectorXd gamma = random_gamma(reduction, random);
                gamma *= std::sqrt(level / (reduction.energy_factor * gamma.squaredNorm()));
                const VectorXd x = program.point(gamma);
                EXPECT_LT((program.gamma(x) - gamma).norm(), rounding * gamma.norm());
                const double value = objective_of_waves(kernel, objective, reduction.beta(gamma), reference);
                EXPECT_NEAR(program.objective_unit * program.program.objective(x), value, rounding * (1 + value));
                // A point at the level is on the unit sphere.
                EXPECT_NEAR(program.program.sphere_residual(x), 0, rounding);
            }
        }
    }
}

TEST(OrbitProgram, ConstraintsAreTheConditionsOfTheTip) {
    std::mt19937 random(11);
    for (const auto& [pattern, gap_sign] : cases) {
        const Kernel kernel = exact_kernel(pattern);
        const Reduction reduction = reduce(conditions(kernel, gap_sign));
        if (reduction.variables() == 0) continue;
        const auto program = orbit_program(reduction, kernel, Objective::least_shock, 2.0);
        for (int trial = 0; trial < 20; ++trial) {
            const VectorXd gamma = random_gamma(reduction, random);
            const VectorXd tip = nsma::tip_history(kernel, reduction.beta(gamma));
            const VectorXd x = program.point(gamma);
            const double contact_norm = reduction.contact_row.cast<double>().norm();
            if (contact_norm > 0) {
                const double defect = (program.program.equalities * x - program.program.equality_values)[0];
                EXPECT_NEAR(defect * contact_norm * program.scale, tip[0] - gap_sign,
                            rounding * (1 + std::abs(tip[0])));
            }
            const VectorXd rows = program.program.inequalities * x - program.program.inequality_values;
            ASSERT_EQ(rows.size(), static_cast<Eigen::Index>(reduction.row_step.size()));
            for (Eigen::Index i = 0; i < rows.size(); ++i) {
                const double norm = reduction.rows.row(i).cast<double>().norm();
                const int n = reduction.row_step[static_cast<std::size_t>(i)];
                EXPECT_NEAR(2 * rows[i] * norm * program.scale, tip[n] - tip[0], rounding * (1 + gamma.lpNorm<1>()));
                EXPECT_NEAR(program.program.inequalities.row(i).norm(), 1, rounding);  // scaled rows
            }
        }
    }
}

TEST(OrbitProgram, PeakForceIsTheLeastUnknownAboveEveryContactWave) {
    std::mt19937 random(12);
    const Kernel kernel = exact_kernel({6, 16, 4});
    const Reduction reduction = reduce(conditions(kernel, 1));
    const auto program = orbit_program(reduction, kernel, Objective::least_force, 12.0);
    EXPECT_EQ(program.program.variables(), 5);
    EXPECT_EQ(program.program.sphere_variables, 4);  // the peak is not on the sphere
    VectorXd gamma = random_gamma(reduction, random);
    gamma /= gamma.sum();  // COND2: the contact row is all ones
    gamma *= 1.0;
    const VectorXd x = program.point(gamma);
    EXPECT_NEAR(x[4] * program.scale, gamma.maxCoeff(), rounding);
    VectorXd lower = x;
    lower[4] -= 1e-3;
    EXPECT_GT((program.program.inequalities * lower - program.program.inequality_values).maxCoeff(), 1e-4);
    EXPECT_LT((program.program.inequalities * x - program.program.inequality_values).maxCoeff(), rounding);
}

TEST(OrbitProgram, RefusesBadObjectivesLevelsAndReferences) {
    const Kernel kernel = exact_kernel({6, 16, 4});
    const Reduction reduction = reduce(conditions(kernel, 1));
    const auto build = [&](Objective objective, double level, const VectorXd& reference) {
        (void)orbit_program(reduction, kernel, objective, level, reference);
    };
    EXPECT_THROW(build(Objective::min_energy, 10.0, {}), std::invalid_argument);
    EXPECT_THROW(build(Objective::max_energy, 10.0, {}), std::invalid_argument);
    EXPECT_THROW(build(Objective::least_shock, 0.0, {}), std::invalid_argument);
    EXPECT_THROW(build(Objective::least_shock, -1.0, {}), std::invalid_argument);
    EXPECT_THROW(build(Objective::least_shock, std::nan(""), {}), std::invalid_argument);
    EXPECT_THROW(build(Objective::nearest, 10.0, {}), std::invalid_argument);
    EXPECT_THROW(build(Objective::nearest, 10.0, VectorXd::Zero(11)), std::invalid_argument);
    EXPECT_NO_THROW(build(Objective::nearest, 10.0, VectorXd::Zero(12)));
}

}  // namespace
