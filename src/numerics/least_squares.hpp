#pragma once

#include <vector>

#include <Eigen/Core>

namespace nsma {

/// Nonnegative least squares: y >= 0 that minimises |matrix y - target|.
struct NonnegativeSolution {
    Eigen::VectorXd y;         ///< size = columns of the matrix
    Eigen::VectorXd residual;  ///< target - matrix y
    std::vector<int> support;  ///< columns with y > 0, linearly independent, increasing
    bool converged = false;    ///< false: the iteration limit ended it
};

/// Active-set method of Lawson and Hanson (Solving Least Squares Problems, 1974, chapter 23).
/// A column enters when its correlation with the residual exceeds `tolerance` times the product
/// of their norms. Throws std::invalid_argument on a size mismatch.
[[nodiscard]] NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& matrix,
                                                            const Eigen::VectorXd& target, double tolerance = 1e-12);

}  // namespace nsma
