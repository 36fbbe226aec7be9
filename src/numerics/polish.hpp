#pragma once

#include <Eigen/Core>

#include "program.hpp"

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

/// A point moved onto its active set.
struct Polished {
    Eigen::VectorXd x;
    bool feasible = false;    ///< every constraint within PolishOptions::feasibility
    bool stationary = false;  ///< KKT residual within PolishOptions::stationarity
    double objective = 0;
    Multipliers multipliers;
    int steps = 0;
    /// Lower bound on the objective over the whole feasible set from the Lagrangian with these
    /// multipliers (weak duality), -infinity when it gives none.
    double lower_bound = -no_bound;
};

struct PolishOptions {
    double feasibility = 1e-12;  ///< largest violation, scaled rows
    double stationarity = 1e-9;  ///< relative KKT residual
    double activity = 1e-10;     ///< slack below which a row is active
    int max_steps = 200;
};

/// Active-set descent from a feasible point: Newton steps on the flat of the active rows cut
/// with the sphere, blocked by the other rows, until the projection of -gradient on the tangent
/// cone vanishes. The objective never rises, but for rounding and for the last step to a vertex on the sphere that is
/// less than 1e-6 away. `start` must be feasible to 1e-9.
[[nodiscard]] Polished polish(const Program& program, const Eigen::VectorXd& start, const PolishOptions& options = {});

}  // namespace nsma
