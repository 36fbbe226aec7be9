#include "nsma/orbit/kernel.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dense_kernel.hpp"
#include "wave/dense_wfem.hpp"

namespace {

using Eigen::MatrixXd;
using nsma::exact_kernel;
using nsma::Kernel;
using nsma::Pattern;

/// States [sigma/z; v] of waves b_0..b_{2N-1}: cell i holds the wave that arrives after N - i
/// steps and, reversed at the fixed end, the one that arrives after N + i - 1.
MatrixXd scaled_states(const MatrixXd& waves) {
    const Eigen::Index cells = waves.rows() / 2;
    MatrixXd states(waves.rows(), waves.cols());
    for (Eigen::Index i = 1; i <= cells; ++i) {
        states.row(i - 1) = -(waves.row(cells - i) + waves.row(cells + i - 1));
        states.row(cells + i - 1) = waves.row(cells - i) - waves.row(cells + i - 1);
    }
    return states;
}

TEST(Kernel, SmallestFirstModeByHand) {
    // N = 2, (6, 1): 2N = 4, steps visited 0 4 1 5 2 6 3, sign flipped after 0 4 1 5 2 (and 3),
    // kept after 6: + - + - + - -, and 3 (free) brings it back to +.
    const Kernel kernel = exact_kernel({2, 6, 1});
    EXPECT_EQ(kernel.classes, 1);
    EXPECT_EQ(kernel.dimension(), 1);
    EXPECT_EQ(kernel.sign, (std::vector<std::int8_t>{1, 1, 1, -1, -1, -1, -1}));
    EXPECT_EQ(kernel.class_of, (std::vector<int>{0}));
    EXPECT_EQ(kernel.column(6), 0);
}

TEST(Kernel, DeadClassesByHand) {
    // N = 2, (5, 1): g = 2, class 0 holds steps 0 2 4 (three free steps: dead), class 1 holds
    // 1 3 (free) and 5: visited 1 5 3, signs + - -.
    const Kernel kernel = exact_kernel({2, 5, 1});
    EXPECT_EQ(kernel.classes, 2);
    EXPECT_EQ(kernel.sign, (std::vector<std::int8_t>{0, 1, 0, -1, 0, -1}));
    EXPECT_EQ(kernel.amplitude_of, (std::vector<int>{-1, 0}));
    EXPECT_EQ(kernel.class_of, (std::vector<int>{1}));
    EXPECT_EQ(kernel.column(2), -1);
    EXPECT_EQ(kernel.column(3), 0);
    EXPECT_EQ(exact_kernel({2, 5, 2}).dimension(), 0);
}

TEST(Kernel, WavesRepeatAfterThePeriodAndFlipOnlyInFreeFlight) {
    for (const Pattern& pattern : {Pattern{1000, 2345, 655}, Pattern{1000, 2399, 1}, Pattern{360, 1, 719},
                                   Pattern{50, 3, 2}, Pattern{7, 300, 41}, Pattern{500, 1000, 600}}) {
        const Kernel kernel = exact_kernel(pattern);
        const int period = pattern.period_steps();
        EXPECT_EQ(kernel.dimension(), nsma::kernel_dimension(pattern));
        for (int n = 0; n < period; ++n) {
            const auto next = static_cast<std::size_t>((n + 2 * pattern.cells) % period);
            const int flip = n < pattern.free_steps ? -1 : 1;
            const int sign = kernel.sign[static_cast<std::size_t>(n)];
            ASSERT_EQ(kernel.sign[next], flip * sign);
            ASSERT_EQ(sign != 0, kernel.column(n) >= 0);
        }
        EXPECT_TRUE(std::is_sorted(kernel.class_of.begin(), kernel.class_of.end()));
        for (int column = 0; column < kernel.dimension(); ++column) {
            const int first = kernel.class_of[static_cast<std::size_t>(column)];
            EXPECT_EQ(kernel.column(first), column);
            EXPECT_EQ(kernel.sign[static_cast<std::size_t>(first)], 1);
        }
    }
}

TEST(Kernel, WaveBasisIsOrthogonal) {
    for (const Pattern& pattern : {Pattern{6, 16, 4}, Pattern{6, 23, 1}, Pattern{4, 3, 5}, Pattern{9, 2, 1}}) {
        const Kernel kernel = exact_kernel(pattern);
        const MatrixXd basis = nsma::wave_basis(kernel);
        EXPECT_EQ(basis.rows(), 2 * pattern.cells);
        const double squared_norm = 2.0 * pattern.cells / kernel.classes;
        EXPECT_EQ(basis.transpose() * basis, squared_norm * MatrixXd::Identity(basis.cols(), basis.cols()));
    }
}

TEST(Kernel, LargeMeshIsLinearWork) {
    const Kernel kernel = exact_kernel({nsma::max_cells, 4'000'000 - 3, 2});  // n_T odd: g = 1
    EXPECT_EQ(kernel.sign.size(), 3'999'999U);
    EXPECT_EQ(kernel.classes, std::gcd(2'000'000, 3'999'999));
    EXPECT_EQ(kernel.dimension(), nsma::kernel_dimension({nsma::max_cells, 4'000'000 - 3, 2}));
}

TEST(Kernel, Misuse) {
    EXPECT_THROW((void)exact_kernel({2, 0, 1}), std::invalid_argument);
    EXPECT_THROW((void)exact_kernel({2, 1, 0}), std::invalid_argument);
    EXPECT_THROW((void)exact_kernel({0, 1, 1}), std::invalid_argument);
}

/// Dimension and space against the singular value decomposition of the literal S_T, for every
/// r, p >= 1 with r + p <= 6N. One test per N, so that they run side by side.
class KernelAgainstDense : public testing::TestWithParam<int> {};

TEST_P(KernelAgainstDense, EveryPattern) {
    const int cells = GetParam();
    int cases = 0;
    for (const Pattern& pattern : nsma::patterns_in(cells, {.period_hi = 6 * cells})) {
        const MatrixXd dense = nsma::dense::svd_kernel(nsma::Bar{}, pattern);
        const Kernel kernel = exact_kernel(pattern);
        ASSERT_EQ(kernel.dimension(), dense.cols()) << "r " << pattern.free_steps << ", p " << pattern.contact_steps;
        ASSERT_EQ(nsma::kernel_dimension(pattern), dense.cols());
        if (dense.cols() > 0) {
            // Same dimension, and no part of the exact space outside the dense one.
            MatrixXd exact = scaled_states(nsma::wave_basis(kernel));
            exact.colwise().normalize();
            const MatrixXd outside = exact - dense * (dense.transpose() * exact);
            // Singular vectors: 1e-15 over the gap of the spectrum, at least
            // 2 sin(pi/(2 * 48)) > 0.06 for cycles of at most 48 steps.
            ASSERT_LT(outside.cwiseAbs().maxCoeff(), 1e-12)
                << "r " << pattern.free_steps << ", p " << pattern.contact_steps;
        }
        ++cases;
    }
    EXPECT_EQ(cases, 3 * cells * (6 * cells - 1));
}

INSTANTIATE_TEST_SUITE_P(UpToEightCells, KernelAgainstDense, testing::Range(1, 9));

/// And without any decomposition: the literal steps bring every basis state back.
TEST(Kernel, LiteralStepsBringEveryBasisStateBack) {
    for (const nsma::Bar& bar : {nsma::Bar{}, nsma::Bar{1.0, 210e9, 7850.0, 1e-4, 1e-4}}) {
        for (const Pattern& pattern :
             {Pattern{6, 16, 4}, Pattern{6, 23, 1}, Pattern{20, 48, 16}, Pattern{20, 60, 20}, Pattern{3, 7, 11}}) {
            const nsma::Mesh mesh{pattern.cells};
            MatrixXd states = scaled_states(nsma::wave_basis(exact_kernel(pattern)));
            states.topRows(pattern.cells) *= bar.impedance();
            for (Eigen::Index column = 0; column < states.cols(); ++column) {
                nsma::State state = states.col(column);
                for (int n = 0; n < pattern.period_steps(); ++n) {
                    nsma::dense::cell_step(bar, mesh, n >= pattern.free_steps, state);
                }
                // 80 steps of rounding on numbers of order 1.
                EXPECT_LT((state - states.col(column)).norm() / state.norm(), 1e-13);
            }
        }
    }
}

}  // namespace
