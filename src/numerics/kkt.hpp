#pragma once

#include <vector>

#include <Eigen/Core>

#include "boundary.hpp"

namespace nsma {

/// Multipliers of a point, from our own KKT system:
///   gradient f + equalities' nu + inequalities' y - z_lower + z_upper + 2 mu x_S = 0,
/// y, z >= 0. Nondimensional, in the scale of the program.
struct Multipliers {
    Eigen::VectorXd equality;    ///< nu, any sign
    Eigen::VectorXd inequality;  ///< y >= 0, zero off the active set
    Eigen::VectorXd lower;       ///< z_lower >= 0
    Eigen::VectorXd upper;       ///< z_upper >= 0
    double sphere = 0;           ///< mu, any sign
    double residual = 0;         ///< norm of the left side, relative to 1 + |gradient f|
};

/// Multipliers at x, and the projection of -gradient on the tangent cone of its active rows.
struct FirstOrder {
    Multipliers multipliers;
    Eigen::VectorXd direction;
};
[[nodiscard]] FirstOrder first_order(const Boundary& boundary, const std::vector<Row>& active,
                                     const Eigen::VectorXd& x);

/// Lower bound on the objective over the whole feasible set by weak duality from a stationary point: the best of inf L
/// over the flat of the equalities, over the sphere's multiplier only; -no_bound when it gives none.
[[nodiscard]] double dual_bound(const Boundary& boundary, const Eigen::VectorXd& x, const Multipliers& multipliers);

}  // namespace nsma
