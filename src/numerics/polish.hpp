#pragma once

#include <Eigen/Core>

#include "kkt.hpp"
#include "program.hpp"

namespace nsma {

/// A point moved onto its active set.
struct Polished {
    Eigen::VectorXd x;
    bool feasible = false;    ///< every constraint within PolishOptions::feasibility
    bool stationary = false;  ///< KKT residual within PolishOptions::stationarity
    double objective = 0;
    Multipliers multipliers;
    int steps = 0;  ///< at most 200
    /// Lower bound on the objective over the whole feasible set from the Lagrangian with these
    /// multipliers (weak duality), -infinity when it gives none.
    double lower_bound = -no_bound;
};

/// What polish() takes for zero, in the scale of the program.
struct PolishOptions {
    static constexpr double feasibility = 1e-12;  ///< largest violation, scaled rows
    static constexpr double stationarity = 1e-9;  ///< relative KKT residual
    static constexpr double activity = 1e-10;     ///< slack below which a row is active
};

/// Active-set descent from a feasible point: Newton steps on the flat of the active rows cut
/// with the sphere, blocked by the other rows, until the projection of -gradient on the tangent
/// cone vanishes. The objective never rises, but for rounding and for the last step to a vertex on the sphere that is
/// less than 1e-6 away. `start` must be feasible to 1e-9.
[[nodiscard]] Polished polish(const Program& program, const Eigen::VectorXd& start);

}  // namespace nsma
