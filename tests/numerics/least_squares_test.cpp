#include "numerics/least_squares.hpp"

#include <random>
#include <stdexcept>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using nsma::nonnegative_least_squares;

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index, Eigen::Index) { return normal(random); });
}

/// Least |matrix y - target| over y >= 0 by trying every support.
double brute_force(const MatrixXd& matrix, const VectorXd& target) {
    double best = target.norm();
    const auto columns = static_cast<int>(matrix.cols());
    for (int code = 1; code < 1 << columns; ++code) {
        std::vector<int> support;
        for (int j = 0; j < columns; ++j) {
            if ((code >> j & 1) != 0) support.push_back(j);
        }
        const MatrixXd part = matrix(Eigen::all, support);
        const VectorXd y = part.completeOrthogonalDecomposition().solve(target);
        if (y.minCoeff() >= 0) best = std::min(best, (part * y - target).norm());
    }
    return best;
}

/// y >= 0, residual = target - matrix y, matrix' residual <= 0 and zero on the support.
void expect_optimal(const MatrixXd& matrix, const VectorXd& target) {
    const auto solution = nonnegative_least_squares(matrix, target);
    ASSERT_TRUE(solution.converged);
    ASSERT_EQ(solution.y.size(), matrix.cols());
    EXPECT_GE(solution.y.minCoeff(), 0.0);
    // Rounding of products of numbers of order one, with up to 40 terms.
    const double rounding = 1e-11 * (1 + target.norm());
    EXPECT_LT((target - matrix * solution.y - solution.residual).norm(), rounding);
    const VectorXd slope = matrix.transpose() * solution.residual;
    EXPECT_LT(slope.maxCoeff(), rounding * (1 + matrix.norm()));
    for (Eigen::Index j = 0, k = 0; j < matrix.cols(); ++j) {
        const bool in = k < static_cast<Eigen::Index>(solution.support.size()) &&
                        solution.support[static_cast<std::size_t>(k)] == j;
        EXPECT_EQ(solution.y[j] > 0, in);
        if (!in) continue;
        ++k;
        EXPECT_LT(std::abs(slope[j]), rounding * (1 + matrix.norm()));
    }
    if (!solution.support.empty()) {
        const MatrixXd part = matrix(Eigen::all, solution.support);
        EXPECT_EQ(part.colPivHouseholderQr().rank(), part.cols());  // independent
    }
}

TEST(NonnegativeLeastSquares, EqualsBruteForceOverSupports) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 300; ++trial) {
        const Eigen::Index rows = 1 + trial % 6;
        const Eigen::Index columns = 1 + trial % 7;
        const MatrixXd matrix = random_matrix(rows, columns, random);
        const VectorXd target = random_matrix(rows, 1, random);
        const auto solution = nonnegative_least_squares(matrix, target);
        // Both solve the same small dense systems to rounding.
        EXPECT_NEAR(solution.residual.norm(), brute_force(matrix, target), 1e-11 * (1 + target.norm()));
    }
}

TEST(NonnegativeLeastSquares, MeetsTheOptimalityConditions) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 60; ++trial) {
        const Eigen::Index rows = 1 + trial % 30;
        const Eigen::Index columns = 1 + (7 * trial) % 40;
        expect_optimal(random_matrix(rows, columns, random), random_matrix(rows, 1, random));
    }
}

TEST(NonnegativeLeastSquares, SmallIntegersWithTies) {
    // The rows of this project: entries -1, 0, 1, many of them equal.
    std::mt19937 random(4);
    std::uniform_int_distribution<int> draw(-1, 1);
    for (int trial = 0; trial < 200; ++trial) {
        const MatrixXd matrix = MatrixXd::NullaryExpr(4, 9, [&](Eigen::Index, Eigen::Index) { return draw(random); });
        const VectorXd target = VectorXd::NullaryExpr(4, [&](Eigen::Index) { return draw(random); });
        const auto solution = nonnegative_least_squares(matrix, target);
        ASSERT_TRUE(solution.converged);
        EXPECT_NEAR(solution.residual.norm(), brute_force(matrix, target), 1e-12);
    }
}

TEST(NonnegativeLeastSquares, ByHand) {
    // Columns (1, 0) and (0, 1), target (3, -4): only the first can help.
    const auto solution = nonnegative_least_squares(MatrixXd::Identity(2, 2), Eigen::Vector2d(3, -4));
    EXPECT_EQ(solution.y, VectorXd(Eigen::Vector2d(3, 0)));
    EXPECT_EQ(solution.residual, VectorXd(Eigen::Vector2d(0, -4)));
    EXPECT_EQ(solution.support, std::vector<int>{0});
}

TEST(NonnegativeLeastSquares, DuplicateAndZeroColumns) {
    MatrixXd matrix(2, 4);
    matrix << 1, 1, 0, 2,  //
        1, 1, 0, 2;
    const VectorXd target = Eigen::Vector2d(2, 0);
    expect_optimal(matrix, target);
    const auto solution = nonnegative_least_squares(matrix, target);
    EXPECT_EQ(solution.support.size(), 1U);
    EXPECT_NEAR(solution.residual.norm(), std::sqrt(2.0), 1e-15);  // projection on (1, 1) is (1, 1)
}

TEST(NonnegativeLeastSquares, ZeroTargetAndNoColumns) {
    std::mt19937 random(5);
    const auto zero = nonnegative_least_squares(random_matrix(3, 5, random), VectorXd::Zero(3));
    EXPECT_TRUE(zero.converged);
    EXPECT_TRUE(zero.y.isZero(0));
    EXPECT_TRUE(zero.support.empty());
    const auto empty = nonnegative_least_squares(MatrixXd(2, 0), Eigen::Vector2d(1, 2));
    EXPECT_TRUE(empty.converged);
    EXPECT_EQ(empty.residual, VectorXd(Eigen::Vector2d(1, 2)));
}

TEST(NonnegativeLeastSquares, SizeMismatchThrows) {
    EXPECT_THROW((void)nonnegative_least_squares(MatrixXd::Identity(2, 2), VectorXd::Zero(3)), std::invalid_argument);
}

}  // namespace
