#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "nsma/set/objective.hpp"
#include "nsma/price/relaxed_set.hpp"

namespace nsma {

/// Derivative of the optimal objective along a direction of the right-hand sides,
/// nondimensional: V(t) - V(0) for the right-hand sides at t times the direction.
struct Slope {
    /// How much of a derivative there is.
    enum class Kind {
        two_sided,  ///< right == left: the derivative exists
        one_sided,  ///< they differ, or there is no orbit on one side
        refused     ///< no number: the reason says why
    };
    Kind kind = Kind::refused;    ///< what `right` and `left` hold
    std::optional<double> right;  ///< lim (V(t) - V(0))/t, t > 0
    std::optional<double> left;   ///< lim (V(0) - V(-t))/t, t > 0
    /// V(t) - V(0) = root sqrt(t) + O(t): the level is an end of the energy interval, where the
    /// derivative is infinite.
    std::optional<double> right_root;
    std::optional<double> left_root;  ///< the same for V(-t) - V(0)
    std::string reason;               ///< one line; empty for two_sided
};

/// Derivative of beta itself along a direction.
struct OrbitSlope {
    std::optional<Eigen::VectorXd> beta;  ///< size m; absent: refused
    std::string reason;                   ///< one line; why it is refused
};

class OptimumAnalysis;

/// First-order sensitivity of one optimum, from our own KKT system over all rows of COND1-3
/// (units: those of Shift and of objective_of_waves):
///   grad f + sum y_i row_i + nu contact + 2 mu (energy) = 0,  y >= 0,  V' = -(y, nu, mu) . rhs'.
/// Each one-sided derivative is the greatest V' over the multipliers (y, nu, mu) of the point, a
/// linear program where they are not unique. Where the level is an end of the energy interval
/// that end's own derivative decides whether there is an orbit, and a projection on the critical
/// cone gives the root of the square-root branch. What lies between `active` and `inactive` is
/// neither, and refused. Where several optima tie (time shifts and reversals of an orbit that rests at the wall,
/// permuted peaks) the right derivative is the least and the left one the greatest over all of them. `set` must outlive
/// this. Source: J. F. Bonnans, A. Shapiro, SIAM Review 40 (1998) 228-264.
class OptimumSensitivity {
public:
    /// `beta` is an optimum at `level` (absent for min_energy and max_energy only), `reference` the window that
    /// `nearest` stays near. Throws std::invalid_argument on a wrong size, a missing or a misplaced level.
    OptimumSensitivity(const RelaxedSet& set, Objective objective, std::optional<double> level,
                       const Eigen::VectorXd& beta, const Eigen::VectorXd& reference = {});

    /// Empty, or why nothing can be said: not stationary, a row neither active nor inactive.
    [[nodiscard]] const std::string& refusal() const { return refusal_; }
    [[nodiscard]] double value() const;          ///< objective, as reported
    [[nodiscard]] Eigen::VectorXd beta() const;  ///< polished
    [[nodiscard]] bool nondegenerate() const;    ///< independent active rows, positive multipliers
    /// Optima of this value that symmetries give, this one included; 0: too many.
    [[nodiscard]] int tied() const { return tied_; }
    [[nodiscard]] std::vector<int> active_rows() const;  ///< of the set
    /// Relative to 1 + |grad f|, scaled; absent where there are no multipliers.
    [[nodiscard]] std::optional<double> kkt_residual() const;
    /// |delta f_delta + 2 e f_e - k f|/|k f| with the multipliers, k the degree of the objective
    /// (2; 1 for least_force). Absent for `nearest` and where there are no multipliers.
    [[nodiscard]] std::optional<double> euler_defect() const;

    /// Derivative of the objective along `direction`.
    [[nodiscard]] Slope slope(const Shift& direction) const;
    /// Derivative of beta: implicit function theorem on the active set; T fixed.
    [[nodiscard]] OrbitSlope orbit_slope(const Shift& direction) const;

private:
    std::vector<std::shared_ptr<const OptimumAnalysis>> branches_;  // the optimum, then its ties
    Objective objective_;
    std::string refusal_;
    int tied_ = 0;
};

}  // namespace nsma
