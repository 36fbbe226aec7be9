#include "study/accuracy/kernel_methods.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "../orbit/dense_kernel.hpp"

namespace {

using nsma::KernelMethod;
using nsma::Pattern;

constexpr KernelMethod methods[] = {KernelMethod::exact_cycles, KernelMethod::dense_svd,
                                    KernelMethod::rank_revealing_qr, KernelMethod::matrix_powers};

const nsma::Bar steel{1.0, 210e9, 7850.0, 1e-4, 1e-4};

TEST(KernelMethods, AllSpanTheSameSpace) {
    for (int cells = 1; cells <= 6; ++cells) {
        for (int steps = 2; steps <= 4 * cells + 3; ++steps) {
            for (int contact = 1; contact < steps; ++contact) {
                const Pattern pattern{cells, steps - contact, contact};
                const Eigen::MatrixXd reference = nsma::dense::svd_kernel(steel, pattern);
                for (const auto method : methods) {
                    const Eigen::MatrixXd basis = nsma::kernel_space(method, steel, pattern);
                    ASSERT_EQ(basis.cols(), nsma::kernel_dimension(pattern))
                        << nsma::name(method) << ' ' << cells << ' ' << steps - contact << ' ' << contact;
                    // Matrices of size 12 with entries of order one.
                    EXPECT_LE(nsma::space_distance(basis, reference), 1e-12) << nsma::name(method);
                    EXPECT_LE(
                        (basis.transpose() * basis - Eigen::MatrixXd::Identity(basis.cols(), basis.cols())).norm(),
                        1e-12);
                }
            }
        }
    }
}

TEST(KernelMethods, ToleranceDecidesTheDimension) {
    const Pattern pattern{10, 11, 4};
    const Eigen::Vector3d tolerances(1e-16, 1e-9, 10.0);
    for (const auto method : {KernelMethod::dense_svd, KernelMethod::rank_revealing_qr}) {
        const Eigen::VectorXi found = nsma::dimensions_found(method, steel, pattern, tolerances);
        EXPECT_EQ(found[1], nsma::kernel_dimension(pattern));
        EXPECT_LE(found[0], found[1]);
        EXPECT_EQ(found[2], 20);  // everything is zero
    }
    EXPECT_THROW((void)nsma::dimensions_found(KernelMethod::exact_cycles, steel, pattern, tolerances),
                 std::invalid_argument);
    EXPECT_THROW((void)nsma::kernel_space(KernelMethod::dense_svd, steel, pattern, 0), std::invalid_argument);
}

TEST(KernelMethods, DistanceOfSpaces) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(4, 2);
    Eigen::MatrixXd b = a;
    EXPECT_EQ(nsma::space_distance(a, b), 0.0);
    b.col(0) << std::cos(0.25), 0, std::sin(0.25), 0;
    EXPECT_NEAR(nsma::space_distance(a, b), std::sin(0.25), 1e-15);
    EXPECT_EQ(nsma::space_distance(a, Eigen::MatrixXd::Identity(4, 3)), 1.0);
    EXPECT_EQ(nsma::space_distance(Eigen::MatrixXd(4, 0), Eigen::MatrixXd(4, 0)), 0.0);
    EXPECT_THROW((void)nsma::space_distance(a, Eigen::MatrixXd::Identity(3, 2)), std::invalid_argument);
}

}  // namespace
