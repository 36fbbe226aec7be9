#include "nsma/orbit/conditions.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "wave/dense_wfem.hpp"

namespace {

using Eigen::VectorXd;
using Eigen::VectorXi;
using nsma::Bar;
using nsma::Conditions;
using nsma::conditions;
using nsma::exact_kernel;
using nsma::Kernel;
using nsma::Mesh;
using nsma::Pattern;
using nsma::State;
using Sign = nsma::Conditions::Sign;

const Bar bars[] = {{}, {0.5, 210e9, 7850.0, 1e-4, -1e-4}, {2.0, 3.0, 5.0, 7.0, 0.0}};

/// Patterns with 2N above, below and equal to n_T, with and without dead classes.
const Pattern patterns[] = {{6, 16, 4}, {6, 23, 1}, {2, 6, 1},    {3, 3, 1},   {8, 1, 1},
                            {8, 2, 3},  {5, 3, 7},  {20, 48, 16}, {7, 40, 16}, {10, 3, 1}};

/// Q0 from the definitions: b_k = eps_k alpha, alpha = beta u/dt, and the literal state of waves.
State initial_state(const Bar& bar, const Kernel& kernel, const VectorXd& beta) {
    const int cells = kernel.pattern.cells;
    const VectorXd waves = nsma::wave_basis(kernel) * beta * bar.displacement_unit() / Mesh{cells}.time_step(bar);
    State state(2 * cells);
    for (int i = 1; i <= cells; ++i) {
        state[i - 1] = -bar.impedance() * (waves[cells - i] + waves[cells + i - 1]);
        state[cells + i - 1] = waves[cells - i] - waves[cells + i - 1];
    }
    return state;
}

/// What the literal scheme gives over one labelled period, nondimensional.
struct Marched {
    VectorXd tip;    ///< n = 0..n_T, from the strain
    VectorXd force;  ///< S (sigma_N - z v_N) of contact steps, n = r..n_T-1, per force unit
};

Marched march_literally(const Bar& bar, const Pattern& pattern, State state) {
    const Mesh mesh{pattern.cells};
    Marched result{VectorXd(pattern.period_steps() + 1), VectorXd(pattern.contact_steps)};
    for (int n = 0; n <= pattern.period_steps(); ++n) {
        result.tip[n] = nsma::tip_displacement(bar, mesh, state) / bar.displacement_unit();
        if (n >= pattern.free_steps && n < pattern.period_steps()) {
            result.force[n - pattern.free_steps] =
                bar.area * (state[pattern.cells - 1] - bar.impedance() * state[2 * pattern.cells - 1]) /
                bar.force_unit();
        }
        nsma::dense::cell_step(bar, mesh, n >= pattern.free_steps, state);
    }
    return result;
}

VectorXd random_beta(int size, std::mt19937& random) {
    std::normal_distribution<double> normal;
    return VectorXd::NullaryExpr(size, [&](Eigen::Index) { return normal(random); });
}

TEST(Conditions, SmallestFirstModeByHand) {
    // eps = + + + - - - -, r = 6: x_0 = -(1 + 1 + 1 - 1) beta, then +2 eps_n a step.
    const Kernel kernel = exact_kernel({2, 6, 1});
    EXPECT_EQ(nsma::contact_row(kernel), VectorXi::Constant(1, -2));
    VectorXi rows(8);
    rows << -2, 0, 2, 4, 2, 0, -2, -2;
    EXPECT_EQ(nsma::tip_rows(kernel), rows);
    const Conditions limits = conditions(kernel, 1);
    EXPECT_EQ(limits.bound_of, (std::vector<Sign>{Sign::nonpositive}));  // eps_6 = -1
    EXPECT_EQ(limits.energy_factor(), 16.0);
    EXPECT_EQ(limits.dimension(), 1);
    EXPECT_EQ(limits.gap_sign, 1);
}

TEST(Conditions, FourClassesByHand) {
    // N = 6, (16, 4): class j visits j, j+12, j+4, j+16, j+8 with signs + - + - -, so x_0 sums
    // j, j+4, j+8: -(1 + 1 - 1) each, and contact step j+16 carries -1.
    const Kernel kernel = exact_kernel({6, 16, 4});
    EXPECT_EQ(nsma::contact_row(kernel), VectorXi::Constant(4, -1));
    const Conditions limits = conditions(kernel, 1);
    EXPECT_EQ(limits.bound_of, std::vector<Sign>(4, Sign::nonpositive));
    EXPECT_EQ(limits.energy_factor(), 36.0);
}

TEST(Conditions, ConflictAndNoContactByHand) {
    // N = 1, (1, 2): g = 1, visits 0, 2, 1 with signs + - - and closes with no flip: one free
    // step, dead. N = 1, (2, 2): g = 2, q = 1, s = 0: dead. N = 2, (2, 3): g = 1, visits
    // 0 4 3 2 1: + - - - -, closes with a flip at 1. Contact 2 3 4 all minus.
    EXPECT_EQ(conditions(exact_kernel({2, 2, 3}), 1).bound_of, (std::vector<Sign>{Sign::nonpositive}));
    // N = 3, (2, 7): g = 3, q = 0, s = 2: class 2 alone lives, steps 2 5 8, all contact: + + +.
    EXPECT_EQ(conditions(exact_kernel({3, 2, 7}), 1).bound_of, (std::vector<Sign>{Sign::nonnegative}));
    // N = 4, (3, 3): g = 2, q = 1, s = 1: class 0 lives, visits 0 2 4: + - +; contact step 4
    // alone. N = 4, (8, 2) g = 2, q = 4: class 0 visits 0 8 6 4 2: + - - + -: contact 8.
    EXPECT_EQ(conditions(exact_kernel({4, 3, 3}), 1).bound_of, (std::vector<Sign>{Sign::nonnegative}));
    EXPECT_EQ(conditions(exact_kernel({4, 8, 2}), 1).bound_of[0], Sign::nonpositive);
    // N = 3, (4, 1): g = 1, visits 0 1 2 3 4: + - + - +.
    EXPECT_EQ(conditions(exact_kernel({3, 4, 1}), 1).bound_of, (std::vector<Sign>{Sign::nonnegative}));
    // N = 6, (5, 3): g = 4, q = 1, s = 1: class 0 lives, visits 0 4: + -, no contact step.
    EXPECT_EQ(conditions(exact_kernel({6, 5, 3}), 1).bound_of, (std::vector<Sign>{Sign::free}));
    // N = 5, (4, 3): g = 1, visits 0 3 6 2 5 1 4: + - + + - - +; contact 4 5 6: + - +, conflict.
    EXPECT_EQ(conditions(exact_kernel({5, 4, 3}), 1).bound_of, (std::vector<Sign>{Sign::zero}));
}

TEST(Conditions, IntegerRowsAreTheTipOfTheLiteralScheme) {
    std::mt19937 random(6);
    for (const Bar& bar : bars) {
        for (const Pattern& pattern : patterns) {
            const Kernel kernel = exact_kernel(pattern);
            const VectorXd beta = random_beta(kernel.dimension(), random);
            const Marched marched = march_literally(bar, pattern, initial_state(bar, kernel, beta));
            // Sums of up to 2N = 40 waves of order 1, over up to 64 rounded steps.
            const double rounding = 1e-12;
            const VectorXd rows = nsma::tip_rows(kernel).cast<double>() * beta;
            EXPECT_LT((rows - marched.tip).cwiseAbs().maxCoeff(), rounding);
            const VectorXd history = nsma::tip_history(kernel, beta);
            EXPECT_LT((history - marched.tip).cwiseAbs().maxCoeff(), rounding);
        }
    }
}

TEST(Conditions, ContactRowsAreOneRowAndRowsAreWindowSums) {
    for (const Pattern& pattern : patterns) {
        const Kernel kernel = exact_kernel(pattern);
        const Eigen::MatrixXi rows = nsma::tip_rows(kernel);
        const int period = pattern.period_steps();
        ASSERT_EQ(rows.rows(), period + 1);
        EXPECT_EQ(rows.row(0), nsma::contact_row(kernel).transpose());
        for (int n = pattern.free_steps; n <= period; ++n) {
            EXPECT_EQ(rows.row(n), rows.row(0));
        }
        for (int n = 0; n <= period; ++n) {  // x_n = -sum of b_n..b_{n+2N-1}, b of period n_T
            VectorXi sum = VectorXi::Zero(kernel.dimension());
            for (int k = n; k < n + 2 * pattern.cells; ++k) {
                if (kernel.column(k % period) >= 0) {
                    sum[kernel.column(k % period)] -= kernel.sign[static_cast<std::size_t>(k % period)];
                }
            }
            EXPECT_EQ(rows.row(n), sum.transpose());
        }
    }
}

TEST(Conditions, EnergyIsTheSphere) {
    std::mt19937 random(7);
    for (const Bar& bar : bars) {
        for (const Pattern& pattern : patterns) {
            const Kernel kernel = exact_kernel(pattern);
            const VectorXd beta = random_beta(kernel.dimension(), random);
            const double ratio =
                nsma::energy(bar, Mesh{pattern.cells}, initial_state(bar, kernel, beta)) / bar.energy_unit();
            const Conditions limits = conditions(kernel, bar.gap_sign());
            // Sums of 40 squares.
            EXPECT_NEAR(limits.energy_factor() * beta.squaredNorm() / ratio, 1.0, 1e-14);
        }
    }
}

TEST(Conditions, BoundsAreTheSignsOfTheContactForce) {
    std::mt19937 random(8);
    const Bar& bar = bars[1];
    int seen[4] = {0, 0, 0, 0};
    for (int cells = 1; cells <= 6; ++cells) {
        for (const Pattern& pattern : nsma::patterns_in(cells, {.period_hi = 5 * cells})) {
            const Kernel kernel = exact_kernel(pattern);
            const Conditions limits = conditions(kernel, -1);
            for (int column = 0; column < kernel.dimension(); ++column) {
                const Sign sign = limits.bound_of[static_cast<std::size_t>(column)];
                ++seen[static_cast<int>(sign)];
                VectorXd beta = VectorXd::Zero(kernel.dimension());
                beta[column] = 1.0;
                // Linear: one unit amplitude tells both signs.
                const VectorXd force = march_literally(bar, pattern, initial_state(bar, kernel, beta)).force;
                const bool tension_if_positive = force.maxCoeff() > 1e-9;   // forces are 0 or
                const bool tension_if_negative = force.minCoeff() < -1e-9;  // 2N, up to rounding
                EXPECT_EQ(tension_if_positive, sign == Sign::nonpositive || sign == Sign::zero);
                EXPECT_EQ(tension_if_negative, sign == Sign::nonnegative || sign == Sign::zero);
            }
        }
    }
    for (const int count : seen) {
        EXPECT_GT(count, 0);  // every kind was met
    }
}

TEST(Conditions, LongMeshAndPeriodWithoutMatrices) {
    // N = 10^6, p = 1, n_T = 4N - 1: mode 1, eps = + (r/2 times) then -; x_0 = 2N - r in absolute
    // value, and the tip is lowest after r/2 steps: r beta beyond x_0.
    const int cells = nsma::max_cells;
    const int r = 4 * cells - 2;
    const Kernel kernel = exact_kernel({cells, r, 1});
    ASSERT_EQ(kernel.dimension(), 1);
    EXPECT_EQ(nsma::contact_row(kernel)[0], 2 * cells - r);
    const VectorXd beta = VectorXd::Constant(1, 1.0 / (2 * cells - r));
    const VectorXd tip = nsma::tip_history(kernel, beta);
    ASSERT_EQ(tip.size(), 4 * cells);
    const double rounding = 1e-15;  // one division and one product
    EXPECT_NEAR(tip[0], 1.0, rounding);
    EXPECT_EQ(tip[r], tip[0]);
    EXPECT_EQ(tip[r + 1], tip[0]);
    // Running sums of 2 million equal steps of 1e-6: error at most 2e6 ulp(1), random in sign.
    EXPECT_NEAR(tip[r / 2], 1.0 - static_cast<double>(r) / (r - 2 * cells), 1e-10);
    EXPECT_NEAR(tip[r - 1], 1.0 - 2.0 / (r - 2 * cells), 1e-10);
}

TEST(Conditions, Misuse) {
    const Kernel kernel = exact_kernel({6, 16, 4});
    EXPECT_THROW((void)conditions(kernel, 2), std::invalid_argument);
    EXPECT_THROW((void)conditions(kernel, -2), std::invalid_argument);
    EXPECT_THROW((void)nsma::tip_history(kernel, VectorXd::Zero(3)), std::invalid_argument);
}

}  // namespace
