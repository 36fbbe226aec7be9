#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "numerics/linear_program.hpp"

namespace nsma {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The nonlinear program as plain data, scaled so that unknowns and rows are of order one:
///   minimise  x' hessian x / 2 + gradient . x + constant
///   subject to  equalities x = equality_values,  inequalities x <= inequality_values,
///               lower <= x <= upper,  |x_{0..sphere_variables-1}|^2 = 1 (if `sphere_variables` > 0).
/// The sphere is the energy level, the only nonlinear constraint. Nondimensional.
struct Program {
    Eigen::SparseMatrix<double> hessian;  ///< n x n, symmetric, both triangles stored
    Eigen::VectorXd gradient;             ///< size n
    double constant = 0;
    SparseRows equalities;
    Eigen::VectorXd equality_values;
    SparseRows inequalities;
    Eigen::VectorXd inequality_values;
    Eigen::VectorXd lower;  ///< -no_bound where there is none
    Eigen::VectorXd upper;
    int sphere_variables = 0;

    [[nodiscard]] Eigen::Index variables() const { return lower.size(); }
    [[nodiscard]] double objective(const Eigen::VectorXd& x) const;
    [[nodiscard]] Eigen::VectorXd objective_gradient(const Eigen::VectorXd& x) const;
    /// |x|^2 - 1 over the sphere variables; 0 without a sphere.
    [[nodiscard]] double sphere_residual(const Eigen::VectorXd& x) const;
    /// Largest violation of any constraint; infinity for a point with NaN.
    [[nodiscard]] double violation(const Eigen::VectorXd& x) const;
};

/// Throws std::invalid_argument (name, expected, got) on sizes that do not fit, NaN, or a lower
/// bound above its upper bound.
void validate(const Program& program);
/// ... and on a start that is not of its size or not finite.
void validate(const Program& program, const Eigen::VectorXd& start);

}  // namespace nsma
