#pragma once

#include <optional>

#include <Eigen/Core>

#include "orbit_program.hpp"
#include "set/level_points.hpp"

namespace nsma {

/// Brings the raw answer x of a solver to an admissible point nearby: into the bounds, onto
/// COND2, toward an inner point until no row is crossed and, given a level, along a segment onto
/// the level. Returns the reduced point gamma; absent when the level is not reached from there.
[[nodiscard]] std::optional<Eigen::VectorXd> restored(const OrbitProgram& orbit_program, const AdmissibleSet& set,
                                                      const LevelPoints* level, const Eigen::VectorXd& raw);

}  // namespace nsma
