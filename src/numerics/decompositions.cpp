#include "decompositions.hpp"

#include <Eigen/QR>

namespace nsma {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd null_space(const MatrixXd& matrix, Eigen::Index n) {
    if (matrix.rows() == 0) return MatrixXd::Identity(n, n);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(matrix.transpose());
    qr.setThreshold(rank_tolerance);
    MatrixXd basis = MatrixXd::Zero(n, n - qr.rank());
    basis.bottomRows(basis.cols()).setIdentity();
    basis.applyOnTheLeft(qr.householderQ().setLength(qr.rank()));
    return basis;
}

VectorXd least_squares(const MatrixXd& matrix, const VectorXd& target) {
    const Eigen::HouseholderQR<MatrixXd> qr(matrix);
    VectorXd y = qr.solve(target);
    const VectorXd residual = target - matrix * y;
    y += qr.solve(residual);
    return y;
}

struct MinimumNorm::Implementation {
    MatrixXd matrix;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
};

MinimumNorm::MinimumNorm(const MatrixXd& matrix, double threshold)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->matrix = matrix;
    implementation_->decomposition.setThreshold(threshold);
    implementation_->decomposition.compute(matrix);
}

MinimumNorm::~MinimumNorm() = default;

VectorXd MinimumNorm::solve(const VectorXd& target) const { return implementation_->decomposition.solve(target); }

VectorXd MinimumNorm::refined(const VectorXd& target) const {
    const VectorXd first = solve(target);
    return first + solve(target - implementation_->matrix * first);
}

PivotedQr pivoted_qr(const MatrixXd& matrix) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(matrix);
    return {qr.matrixR().diagonal().cwiseAbs(), qr.householderQ() * MatrixXd::Identity(matrix.rows(), matrix.rows())};
}

}  // namespace nsma
