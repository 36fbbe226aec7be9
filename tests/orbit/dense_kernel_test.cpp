#include "dense_kernel.hpp"

#include <stdexcept>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "wave/dense_wfem.hpp"

namespace {

using Eigen::MatrixXd;
using nsma::Bar;
using nsma::Pattern;

const Bar steel{1.0, 210e9, 7850.0, 1e-4, 1e-4};

TEST(DenseKernel, BasisIsOrthonormalAndPeriodic) {
    for (const Bar& bar : {Bar{}, steel}) {
        for (const Pattern& pattern : {Pattern{6, 16, 4}, Pattern{5, 12, 5}, Pattern{8, 31, 1}}) {
            const MatrixXd basis = nsma::dense::svd_kernel(bar, pattern);
            ASSERT_GE(basis.cols(), 1);
            const MatrixXd identity = MatrixXd::Identity(basis.cols(), basis.cols());
            // Rounding of a decomposition of 16 x 16 matrices of norm 2.
            EXPECT_LT((basis.transpose() * basis - identity).norm(), 1e-13);
            MatrixXd states = basis;
            states.topRows(pattern.cells) *= bar.impedance();
            MatrixXd back = nsma::dense::periodicity_matrix(bar, nsma::Mesh{pattern.cells}, pattern.free_steps,
                                                            pattern.contact_steps) *
                            states;
            back.topRows(pattern.cells) /= bar.impedance();
            EXPECT_LT(back.norm(), 1e-12);
        }
    }
}

TEST(DenseKernel, UnitsDoNotChangeTheRank) {
    for (const Pattern& pattern : {Pattern{6, 16, 4}, Pattern{6, 23, 1}, Pattern{6, 3, 5}, Pattern{4, 5, 2}}) {
        EXPECT_EQ(nsma::dense::svd_kernel(steel, pattern).cols(), nsma::dense::svd_kernel(Bar{}, pattern).cols());
    }
}

TEST(DenseKernel, VanishingMatrixHasTheWholeSpace) {
    // A_f^{4N} = A_c^{2N} = I: S_T is zero up to rounding, so no singular value is a scale.
    EXPECT_EQ(nsma::dense::svd_kernel(steel, {3, 12, 6}).cols(), 6);
}

TEST(DenseKernel, Misuse) {
    EXPECT_THROW((void)nsma::dense::svd_kernel(Bar{}, {3, 0, 6}), std::invalid_argument);
    EXPECT_THROW((void)nsma::dense::svd_kernel(Bar{.density = 0.0}, {3, 1, 6}), std::invalid_argument);
}

}  // namespace
