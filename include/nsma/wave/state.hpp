#pragma once

#include <Eigen/Core>

#include "nsma/wave/mesh.hpp"

namespace nsma {

/// State Q = [sigma_1..sigma_N, v_1..v_N]: stress [Pa] and velocity [m/s] of the cells, size 2N.
/// Source: [1] Eq. (1).
using State = Eigen::VectorXd;

/// Total mechanical energy [J]: sum over cells of S dx (sigma^2 / (2Y) + rho v^2 / 2).
/// Throws std::invalid_argument unless Q has size 2N.
[[nodiscard]] double energy(const Bar& bar, const Mesh& mesh, const State& state);

/// Displacement of the contact end [m], positive toward the wall: the integral of the strain
/// sigma/Y over the bar, since the other end is fixed.
[[nodiscard]] double tip_displacement(const Bar& bar, const Mesh& mesh, const State& state);

/// Throws std::invalid_argument (expected, got) unless `state` has size 2N and is finite.
void validate(const Mesh& mesh, const State& state);

}  // namespace nsma
