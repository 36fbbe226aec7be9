#include "kernel_methods.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "wave/dense_wfem.hpp"
#include "nsma/orbit/kernel.hpp"
#include "numerics/decompositions.hpp"

namespace nsma {
namespace {

using Eigen::MatrixXd;

constexpr int most_squarings = 60;

// S_T in the coordinates [sigma/z; v], in which the steps are orthogonal.
MatrixXd periodicity(const Bar& bar, const Pattern& pattern) {
    const int cells = pattern.cells;
    MatrixXd matrix = dense::periodicity_matrix(bar, Mesh{cells}, pattern.free_steps, pattern.contact_steps);
    matrix.topRightCorner(cells, cells) /= bar.impedance();
    matrix.bottomLeftCorner(cells, cells) *= bar.impedance();
    return matrix;
}

// b_{N-i} = (v_i - s_i)/2 and b_{N+i-1} = -(v_i + s_i)/2 with s = sigma/z; columns have norm
// sqrt(2N/g) in b, and |[s; v]|^2 = 2 |b|^2.
MatrixXd cycles_basis(const Pattern& pattern) {
    const Kernel kernel = exact_kernel(pattern);
    const int cells = pattern.cells;
    const double unit = std::sqrt(static_cast<double>(kernel.classes) / (4.0 * cells));
    MatrixXd basis = MatrixXd::Zero(2 * Eigen::Index{cells}, kernel.dimension());
    const int steps = pattern.period_steps();
    const auto add = [&](int n, Eigen::Index row, double factor) {
        n %= steps;  // the window may be longer than the period
        const int column = kernel.column(n);
        if (column >= 0) basis(row, column) += factor * unit * kernel.sign[static_cast<std::size_t>(n)];
    };
    for (int i = 1; i <= cells; ++i) {
        add(cells - i, i - 1, -1.0);
        add(cells + i - 1, i - 1, -1.0);
        add(cells - i, cells + i - 1, 1.0);
        add(cells + i - 1, cells + i - 1, -1.0);
    }
    return basis;
}

Eigen::Index count_zero(const Eigen::VectorXd& values, double tolerance) {
    const double threshold = tolerance * std::max(1.0, values.size() > 0 ? values.maxCoeff() : 1.0);
    return (values.array() <= threshold).count();
}

// Singular values or pivots of S_T, decreasing, and orthonormal columns, of which those of zeros span the kernel.
struct Factors {
    Eigen::VectorXd values;
    MatrixXd basis;
};
Factors factors(KernelMethod method, const MatrixXd& matrix) {
    if (method == KernelMethod::rank_revealing_qr) {
        PivotedQr qr = pivoted_qr(matrix.transpose());
        return {std::move(qr.pivots), std::move(qr.q)};
    }
    Singular right = right_singular(matrix);
    return {std::move(right.values), std::move(right.vectors)};
}

MatrixXd powers_basis(const MatrixXd& matrix, double tolerance) {
    const auto n = matrix.rows();
    MatrixXd projector = MatrixXd::Identity(n, n) + 0.5 * matrix;
    for (int k = 0; k < most_squarings; ++k) {
        const MatrixXd squared = projector * projector;
        const double change = (squared - projector).cwiseAbs().maxCoeff();
        projector = squared;
        if (change <= tolerance) break;
    }
    const Eigen::Index rank = std::lround(projector.trace());
    return pivoted_qr(projector).q.leftCols(std::clamp<Eigen::Index>(rank, 0, n));
}

}  // namespace

std::string_view name(KernelMethod method) {
    switch (method) {
        case KernelMethod::exact_cycles: return "exact cycles";
        case KernelMethod::dense_svd: return "dense SVD";
        case KernelMethod::rank_revealing_qr: return "rank-revealing QR";
        case KernelMethod::matrix_powers: return "matrix powers";
    }
    return "";
}

MatrixXd kernel_space(KernelMethod method, const Bar& bar, const Pattern& pattern, double tolerance) {
    validate(bar);
    validate(pattern);
    if (!(tolerance > 0)) {
        throw std::invalid_argument("tolerance: expected > 0, got " + std::to_string(tolerance));
    }
    if (method == KernelMethod::exact_cycles) return cycles_basis(pattern);
    const MatrixXd matrix = periodicity(bar, pattern);
    if (method == KernelMethod::matrix_powers) return powers_basis(matrix, tolerance);
    const auto [values, basis] = factors(method, matrix);
    return basis.rightCols(count_zero(values, tolerance));
}

Eigen::VectorXi dimensions_found(KernelMethod method, const Bar& bar, const Pattern& pattern,
                                 const Eigen::VectorXd& tolerances) {
    if (method == KernelMethod::exact_cycles || method == KernelMethod::matrix_powers) {
        throw std::invalid_argument("method: expected an SVD or rank-revealing QR, got " + std::string(name(method)));
    }
    const Eigen::VectorXd values = factors(method, periodicity(bar, pattern)).values;
    Eigen::VectorXi found(tolerances.size());
    for (Eigen::Index i = 0; i < tolerances.size(); ++i) {
        found[i] = static_cast<int>(count_zero(values, tolerances[i]));
    }
    return found;
}

double space_distance(const MatrixXd& a, const MatrixXd& b) {
    if (a.rows() != b.rows()) {
        throw std::invalid_argument("b: expected " + std::to_string(a.rows()) + " rows, got " +
                                    std::to_string(b.rows()));
    }
    if (a.cols() != b.cols()) return 1.0;
    if (a.cols() == 0) return 0.0;
    const MatrixXd rest = b - a * (a.transpose() * b);
    return std::min(1.0, std::sqrt(std::max(eigenvalues(rest.transpose() * rest).maxCoeff(), 0.0)));
}

}  // namespace nsma
