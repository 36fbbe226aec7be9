#pragma once

#include <optional>

#include <Eigen/Core>

#include "nsma/program/program.hpp"

namespace nsma {

/// The least point of a program on its equalities and its sphere alone, from one eigenvalue decomposition and a scalar
/// equation; absent where inequalities or bounds refuse it by more than 1e-9, unknowns are off the sphere, or the
/// equalities miss it. Where it is feasible it is the best point of the program.
/// Source: More and Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553-572, with the constraint at equality.
[[nodiscard]] std::optional<Eigen::VectorXd> sphere_minimiser(const Program& program);

}  // namespace nsma
