#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "nsma/set/objective.hpp"
#include "nsma/price/relaxed_set.hpp"

namespace nsma {

/// The optima of the same objective value that the symmetries of a program give beside a known one: its time shifts by
/// whole steps and their reversals that meet COND1-3 of the same pattern and, where the set is a simplex and the
/// objective does not tell its columns apart, its permutations.
struct TiedOptima {
    std::vector<Eigen::VectorXd> others;  ///< beta, without the known one
    std::string refusal;                  ///< more than can be compared; empty when `others` are all
};

/// All vertices (beta) of the greatest energy of a pattern, without a relaxation; none where there is no such energy.
[[nodiscard]] std::vector<Eigen::VectorXd> vertices_of_greatest_energy(const Kernel& kernel, int gap_sign);

/// `beta` must meet the conditions of the set. `reference` as for objective_of_waves (`nearest` only).
[[nodiscard]] TiedOptima tied_optima(const RelaxedSet& set, Objective objective, const Eigen::VectorXd& beta,
                                     const Eigen::VectorXd& reference = {});

}  // namespace nsma
