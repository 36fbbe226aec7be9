#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "decompositions.hpp"

namespace nsma {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::optional<VectorXd> solve_definite(const MatrixXd& matrix, const VectorXd& target) {
    const Eigen::LDLT<MatrixXd> factor(matrix);
    const double least = 1e-12 * matrix.cwiseAbs().maxCoeff();
    if (factor.info() != Eigen::Success || !(factor.vectorD().array() > least).all()) return std::nullopt;
    return factor.solve(target);
}

Spectrum spectrum(const MatrixXd& symmetric) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd eigenvalues(const MatrixXd& symmetric) {
    return Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Singular right_singular(const MatrixXd& matrix) {
    const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeFullV);
    return {svd.singularValues(), svd.matrixV()};
}

Singular left_singular(const MatrixXd& matrix) {
    const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeThinU);
    return {svd.singularValues(), svd.matrixU()};
}

}  // namespace nsma
