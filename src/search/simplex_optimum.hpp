#pragma once

#include <Eigen/Core>

#include "nsma/set/admissible_set.hpp"
#include "nsma/set/objective.hpp"

namespace nsma {

/// An energy level of a set that is a simplex: gamma >= 0, sum of gamma = `sum`, |gamma|^2 = `square`. For a closed gap
/// it is a cone, without the sum. Why the points below are the best of all: data/optima.md.
struct SimplexLevel {
    Eigen::Index size = 1;  ///< n >= 1, number of reduced variables
    double sum = 1;         ///< > 0; 0: a cone
    double square = 1;      ///< in [sum^2/n, sum^2]; of a cone > 0
};

/// The least sum of squared jumps between neighbours, zero before the first and after the last: a hump
/// a + b cos(theta (j - j0)), or cosh, on as many variables in a row as the level lets it cover, here the middle ones.
/// `closure`: weight of a link between the last and the first variable as a share of the others, in (-1, 1).
[[nodiscard]] Eigen::VectorXd smoothest_point(const SimplexLevel& level, double closure);

/// The greatest target . gamma (size n): on the k greatest entries of the target, in proportion to what each is above
/// their mean, for the greatest k that leaves none negative.
[[nodiscard]] Eigen::VectorXd nearest_point(const SimplexLevel& level, const Eigen::VectorXd& target);

/// The least largest entry: as many equal ones as fit, and one for the rest.
[[nodiscard]] Eigen::VectorXd least_peak_point(const SimplexLevel& level);

/// The closure of the objective `least_shock`: 0 unless every class of the kernel is live, so that the last of a round
/// meets the first of the next. The reduction must be of a simplex.
[[nodiscard]] double shock_closure(const Kernel& kernel, const Reduction& reduction);

/// Beta (size m) of the orbit of a kernel that is nearest to a window b_0..b_{2N-1}, conditions aside.
[[nodiscard]] Eigen::VectorXd nearest_beta(const Kernel& kernel, const Eigen::VectorXd& window);

/// The best reduced point of a set that is a simplex at a level (E/E_unit) it attains. `reference`: the window
/// b_0..b_{2N-1} of `nearest`.
[[nodiscard]] Eigen::VectorXd simplex_optimum(const Kernel& kernel, const AdmissibleSet& set, Objective objective,
                                              double level, const Eigen::VectorXd& reference);

}  // namespace nsma
