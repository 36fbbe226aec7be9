#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

namespace nsma {

// Decompositions of dense matrices, compiled once for all rooms: no other source of the numerics instantiates Eigen's.

inline constexpr double rank_tolerance = 1e-11;  ///< relative to the largest pivot; rows are scaled to order one

/// Orthonormal basis (n x k) of the space orthogonal to the rows of `matrix` (R x n, R >= 0).
[[nodiscard]] Eigen::MatrixXd null_space(const Eigen::MatrixXd& matrix, Eigen::Index n);

/// Least squares by Householder QR with one refinement; the columns must be independent.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target);

/// Least-squares solutions of least norm for one matrix of any rank (complete orthogonal decomposition).
class MinimumNorm {
public:
    /// Pivots up to `threshold` times the largest are zero.
    explicit MinimumNorm(const Eigen::MatrixXd& matrix, double threshold = rank_tolerance);
    ~MinimumNorm();
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& target) const;
    [[nodiscard]] Eigen::VectorXd refined(const Eigen::VectorXd& target) const;  ///< with one refinement

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Solution of a symmetric positive definite system by LDL'; absent unless every pivot is above 1e-12 times the largest
/// entry.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_definite(const Eigen::MatrixXd& matrix,
                                                            const Eigen::VectorXd& target);

/// Eigenvalues of a symmetric matrix, increasing, and its orthonormal eigenvectors as columns.
struct Spectrum {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
};
[[nodiscard]] Spectrum spectrum(const Eigen::MatrixXd& symmetric);
[[nodiscard]] Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric);

/// Singular values, decreasing, with singular vectors as columns: all right ones, or the left ones of the values.
struct Singular {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
};
[[nodiscard]] Singular right_singular(const Eigen::MatrixXd& matrix);
[[nodiscard]] Singular left_singular(const Eigen::MatrixXd& matrix);

/// Column-pivoted QR: |pivots|, decreasing, and the square orthogonal factor.
struct PivotedQr {
    Eigen::VectorXd pivots;
    Eigen::MatrixXd q;
};
[[nodiscard]] PivotedQr pivoted_qr(const Eigen::MatrixXd& matrix);

}  // namespace nsma
