#pragma once

#include <Eigen/Core>

#include "numerics/program.hpp"
#include "nsma/set/objective.hpp"
#include "nsma/price/relaxed_set.hpp"

namespace nsma {

/// The nonlinear program of a relaxed set over x = beta/scale. `least_force` adds the peak force
/// as last unknown.
struct RelaxedProgram {
    Program program;
    double scale = 1;           ///< beta = scale x
    double objective_unit = 1;  ///< reported objective = objective_unit * program objective
    Eigen::VectorXd row_norm;   ///< rows of the program are divided by these
    double contact_norm = 0;    ///< likewise COND2's; 0: a row of zeros, left out
    int orbit_variables = 0;
    int peak_rows = 0;  ///< rows after those of the set that hold the peak force up

    [[nodiscard]] Eigen::VectorXd point(const Eigen::VectorXd& beta) const;
    [[nodiscard]] Eigen::VectorXd beta(const Eigen::VectorXd& x) const { return scale * x.head(orbit_variables); }
};

/// Builds it. `level` (E/E_unit before the shift, > 0) fixes the scale and, unless the objective
/// is an energy, the sphere, whose radius follows shift.level. `reference` as for orbit_program
/// (`nearest` only). Throws std::invalid_argument on a level that is not > 0.
[[nodiscard]] RelaxedProgram relaxed_program(const RelaxedSet& set, Objective objective, double level,
                                             const Shift& shift = {}, const Eigen::VectorXd& reference = {});

}  // namespace nsma
