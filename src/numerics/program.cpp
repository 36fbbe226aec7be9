#include "program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "expect_size.hpp"

namespace nsma {
namespace {

void expect_finite(const char* name, const Eigen::VectorXd& values) {
    if (values.allFinite()) return;
    throw std::invalid_argument(std::string(name) + ": expected finite values, got NaN or infinity");
}

template <typename Matrix>
void expect_finite_matrix(const char* name, const Matrix& matrix) {
    for (Eigen::Index outer = 0; outer < matrix.outerSize(); ++outer) {
        for (typename Matrix::InnerIterator entry(matrix, outer); entry; ++entry) {
            if (std::isfinite(entry.value())) continue;
            throw std::invalid_argument(std::string(name) + ": expected finite values, got NaN or infinity in row " +
                                        std::to_string(entry.row()));
        }
    }
}

}  // namespace

double Program::objective(const Eigen::VectorXd& x) const {
    return 0.5 * x.dot(hessian * x) + gradient.dot(x) + constant;
}

Eigen::VectorXd Program::objective_gradient(const Eigen::VectorXd& x) const { return hessian * x + gradient; }

double Program::sphere_residual(const Eigen::VectorXd& x) const {
    return sphere_variables > 0 ? x.head(sphere_variables).squaredNorm() - 1.0 : 0.0;
}

double Program::violation(const Eigen::VectorXd& x) const {
    if (x.size() != variables() || !x.allFinite()) return no_bound;
    double worst = std::abs(sphere_residual(x));
    if (equality_values.size() > 0) {
        worst = std::max(worst, (equalities * x - equality_values).cwiseAbs().maxCoeff());
    }
    if (inequality_values.size() > 0) {
        worst = std::max(worst, (inequalities * x - inequality_values).maxCoeff());
    }
    worst = std::max(worst, (lower - x).maxCoeff());
    return std::max(worst, (x - upper).maxCoeff());
}

void validate(const Program& program) {
    const auto n = program.variables();
    if (n < 1) throw std::invalid_argument("variables: expected >= 1, got 0");
    expect_size("upper", n, program.upper.size());
    expect_size("gradient", n, program.gradient.size());
    expect_size("hessian rows", n, program.hessian.rows());
    expect_size("hessian columns", n, program.hessian.cols());
    expect_size("equalities columns", n, program.equalities.cols());
    expect_size("inequalities columns", n, program.inequalities.cols());
    expect_size("equality_values", program.equalities.rows(), program.equality_values.size());
    expect_size("inequality_values", program.inequalities.rows(), program.inequality_values.size());
    expect_finite("gradient", program.gradient);
    expect_finite("equality_values", program.equality_values);
    expect_finite("inequality_values", program.inequality_values);
    expect_finite_matrix("hessian", program.hessian);
    expect_finite_matrix("equalities", program.equalities);
    expect_finite_matrix("inequalities", program.inequalities);
    if (program.sphere_variables < 0 || program.sphere_variables > n) {
        throw std::invalid_argument("sphere_variables: expected 0.." + std::to_string(n) + ", got " +
                                    std::to_string(program.sphere_variables));
    }
    for (Eigen::Index j = 0; j < n; ++j) {
        if (program.lower[j] <= program.upper[j]) continue;  // false for NaN too
        throw std::invalid_argument("lower[" + std::to_string(j) + "]: expected <= upper = " +
                                    std::to_string(program.upper[j]) + ", got " + std::to_string(program.lower[j]));
    }
}

void validate(const Program& program, const Eigen::VectorXd& start) {
    validate(program);
    if (start.size() == program.variables() && start.allFinite()) return;
    throw std::invalid_argument("start: expected " + std::to_string(program.variables()) + " finite values, got " +
                                std::to_string(start.size()));
}

}  // namespace nsma
