#pragma once

#include <Eigen/Core>

#include "nsma/program/orbit_program.hpp"

namespace nsma {

/// The same program with the tip displacement as unknowns: after the unknowns of the condensed
/// program come the half displacements S_i = (x_n - delta)/2 <= 0 at the steps n of the kept
/// COND1 rows, tied by S_i - S_{i-1} = sum of eps_n beta_{class(n)} over the steps between. The
/// condensed rows hold up to R m nonzeros, these at most n_T + 2 R.
struct LiftedProgram {
    Program program;
    Eigen::Index condensed_variables = 0;

    /// The lifted point of a condensed one; its first unknowns are the condensed point again.
    [[nodiscard]] Eigen::VectorXd point(const Eigen::VectorXd& condensed) const;
};

/// `condensed` must be made from the same reduction and kernel.
[[nodiscard]] LiftedProgram lifted_program(const OrbitProgram& condensed, const Reduction& reduction,
                                           const Kernel& kernel);

/// Which form to hand to an interior point method: the lifted one where the condensed rows have
/// more than `lifted_ratio` times its nonzeros and there are `lifted_rows` of them. Measured:
/// data/bench.
inline constexpr double lifted_ratio = 8.0;
inline constexpr Eigen::Index lifted_rows = 100;
[[nodiscard]] bool prefers_lifted(const OrbitProgram& condensed, const Kernel& kernel);

}  // namespace nsma
