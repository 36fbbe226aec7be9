#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "numerics/program.hpp"

/// Programs whose optimum is derived by hand.
namespace textbook {

using Eigen::Vector3d;
using Eigen::VectorXd;
using nsma::no_bound;
using nsma::Program;
using nsma::SparseRows;

struct Case {
    std::string name;
    Program program;
    VectorXd optimum;
    double value = 0;
};

inline Program unit_sphere(const Vector3d& gradient) {
    Program program;
    program.hessian.resize(3, 3);
    program.gradient = gradient;
    program.equalities.resize(0, 3);
    program.inequalities.resize(0, 3);
    program.lower = VectorXd::Constant(3, -no_bound);
    program.upper = VectorXd::Constant(3, no_bound);
    program.sphere_variables = 3;
    return program;
}

inline SparseRows row(const Vector3d& values) {
    const Eigen::MatrixXd dense = values.transpose();
    return dense.sparseView();
}

/// min 3x + 4y on the unit sphere with -y <= bound. For bound < 4/5 the row is active,
/// y = -bound, x = -sqrt(1 - bound^2); its multiplier is 4 - 3 bound/sqrt(1 - bound^2).
inline Case linear_on_cap(double bound = 0.5) {
    Program program = unit_sphere({3, 4, 0});
    program.inequalities = row({0, -1, 0});
    program.inequality_values = VectorXd::Constant(1, bound);
    const double x = -std::sqrt(1 - bound * bound);
    return {"linear on a cap", program, Vector3d(x, -bound, 0), 3 * x - 4 * bound};
}

/// min 3x + 4y on the unit sphere: minus the gradient over its norm.
inline Case linear_on_sphere() { return {"linear on the sphere", unit_sphere({3, 4, 0}), Vector3d(-0.6, -0.8, 0), -5}; }

/// min x'Hx/2 + g.x on the unit sphere, H = diag(-2, 0, 1). With 2 mu = 3 the matrix H + 2 mu I =
/// diag(1, 3, 4) is positive definite, so x* = (2, -1, 2)/3 is the one global optimum of
/// g = -(H + 3 I) x* = (-2, 3, -8)/3; f = (-8/9 + 4/9)/2 + (-4 - 3 - 16)/9 = -25/9.
inline Case trust_region() {
    Program program = unit_sphere(Vector3d(-2, 3, -8) / 3);
    const Eigen::Matrix3d hessian = Vector3d(-2, 0, 1).asDiagonal();
    program.hessian = hessian.sparseView();
    return {"trust region", program, Vector3d(2, -1, 2) / 3, -25.0 / 9.0};
}

/// min x on the circle |x| = 1, x + y + z = 1: centre (1, 1, 1)/3, radius sqrt(2/3), downhill
/// (-2, 1, 1)/sqrt(6).
inline Case circle() {
    Program program = unit_sphere({1, 0, 0});
    program.equalities = row({1, 1, 1});
    program.equality_values = VectorXd::Ones(1);
    return {"circle", program, Vector3d(-1, 2, 2) / 3, -1.0 / 3.0};
}

/// min -y + 2z on that circle over x, y, z >= 0: the three unit vectors alone are feasible, and at
/// (0, 1, 0) two bounds, the plane and the sphere meet: four gradients in three dimensions.
inline Case degenerate_vertex() {
    Program program = circle().program;
    program.gradient = Vector3d(0, -1, 2);
    program.lower.setZero();
    return {"degenerate vertex", program, Vector3d(0, 1, 0), -1};
}

/// Convex, no sphere: min (x - 2)^2 + (y - 1)^2 + z^2 over x + y <= 2, x <= 1, z >= 1/2: x = 1 and
/// y = 1 meet both rows, f = 1 + 1/4.
inline Case convex() {
    Program program = unit_sphere({-4, -2, 0});
    program.sphere_variables = 0;
    const Eigen::Matrix3d hessian = 2 * Eigen::Matrix3d::Identity();
    program.hessian = hessian.sparseView();
    program.constant = 5;
    program.inequalities = row({1, 1, 0});
    program.inequality_values = VectorXd::Constant(1, 2);
    program.upper[0] = 1;
    program.lower[2] = 0.5;
    return {"convex", program, Vector3d(1, 1, 0.5), 1.25};
}

/// x, y, z >= 0.7 on the unit sphere: at least 1.47 - 1 outside.
inline Program infeasible() {
    Program program = unit_sphere({0, 1, 0});
    program.lower.setConstant(0.7);
    return program;
}

/// The programs with one local optimum, or one that any sensible start leads to.
inline std::vector<Case> all() { return {linear_on_cap(), linear_on_sphere(), trust_region(), circle(), convex()}; }

}  // namespace textbook
