#pragma once

#include <Eigen/Core>

#include "numerics/program.hpp"
#include "nsma/set/objective.hpp"
#include "nsma/set/reduction.hpp"

namespace nsma {

/// The program of one pattern at one energy level over x = gamma/scale, so that the level is
/// the unit sphere. `least_force` adds one unknown, the peak force, after the gammas.
struct OrbitProgram {
    Program program;
    double scale = 1;           ///< gamma = scale * x
    double objective_unit = 1;  ///< reported objective = objective_unit * program objective
    int orbit_variables = 0;    ///< unknowns that are gammas; the first ones

    [[nodiscard]] Eigen::VectorXd gamma(const Eigen::VectorXd& x) const;
    /// x of a reduced point; the peak force takes its least feasible value.
    [[nodiscard]] Eigen::VectorXd point(const Eigen::VectorXd& gamma) const;
};

/// Builds the program of a level (E/E_unit, > 0). `reference` is the window b_0..b_{2N-1} of the orbit to stay near, in
/// units u/dt (size 2N; `nearest` only). Source: [1] COND1-3; objectives as documented at Objective. Throws
/// std::invalid_argument on an objective that is the energy itself, a bad level or reference.
[[nodiscard]] OrbitProgram orbit_program(const Reduction& reduction, const Kernel& kernel, Objective objective,
                                         double level, const Eigen::VectorXd& reference = {});

/// Objective of a reduced point in reported units, straight from the wave amplitudes; the
/// program's own value is checked against it.
[[nodiscard]] double objective_of_waves(const Kernel& kernel, Objective objective, const Eigen::VectorXd& beta,
                                        const Eigen::VectorXd& reference = {});

}  // namespace nsma
