#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "multiplier_set.hpp"
#include "relaxed_program.hpp"
#include "nsma/price/shadow_prices.hpp"

namespace nsma {

/// Change of the optimal value to one side, in the reported unit.
struct Side {
    enum class Status {
        root,        ///< V(t) - V(0) = value sqrt(t) + O(t)
        finite,      ///< V(t) - V(0) = value t + o(t)
        infeasible,  ///< no orbit nearby
        refused
    } status = Status::refused;
    double value = 0;
    std::string reason;
};

/// One optimum over x = beta/scale: its active rows, its multipliers, what the energy level is there, and the slopes
/// that follow. With A the active normals, E COND2's and s the sphere's, the tangent cone is
/// T = { d: A d <= 0, E d = 0 }.
class OptimumAnalysis {
public:
    /// Arguments as those of OptimumSensitivity.
    OptimumAnalysis(const RelaxedSet& set, Objective objective, std::optional<double> level,
                    const Eigen::VectorXd& start, const Eigen::VectorXd& reference);

    [[nodiscard]] const std::string& refusal() const { return refusal_; }
    [[nodiscard]] Eigen::VectorXd beta() const { return form_.beta(x_); }
    [[nodiscard]] double value() const { return form_.program.objective(x_) * form_.objective_unit; }
    [[nodiscard]] double objective_unit() const { return form_.objective_unit; }
    [[nodiscard]] bool nondegenerate() const;
    [[nodiscard]] std::vector<int> active_rows() const;  ///< of the set
    [[nodiscard]] std::optional<double> kkt_residual() const;
    [[nodiscard]] std::optional<double> euler_defect() const;

    /// Derivative of the optimal value to the side of `direction`.
    [[nodiscard]] Side side(const Shift& direction) const;
    /// Derivative of beta by the implicit function theorem on the active set.
    [[nodiscard]] OrbitSlope orbit_slope(const Shift& direction) const;

private:
    /// Where the energy level meets T.
    enum class Place {
        free,    ///< no energy level: a convex program, or a vertex of the greatest energy
        inside,  ///< the energy grows along some d of T and falls along another
        corner,  ///< an end of the energy interval, no d of T keeps the energy: linear growth
        root,    ///< the least energy; the objective falls along some d of T that keeps it
        flat     ///< an end where some d of T keeps energy and objective: second order decides
    };
    /// Rates of the right-hand sides of the program along a direction.
    struct Rates {
        Eigen::VectorXd rows;      ///< of the active inequalities
        Eigen::VectorXd equality;  ///< of COND2 (size 1 or 0)
        double sphere = 0;
        double band = 0;  ///< half width of COND2's band, >= 0
    };

    [[nodiscard]] bool has_sphere() const { return form_.program.sphere_variables > 0; }
    [[nodiscard]] bool at_end() const { return place_ != Place::free && place_ != Place::inside; }
    [[nodiscard]] bool at_fixed_point();
    void set_point(const Eigen::VectorXd& point);
    void find_place();
    void find_multipliers();
    [[nodiscard]] bool has_slope(const std::vector<Eigen::Index>& held);
    /// Multipliers of T for a gradient; a band makes COND2 two rows with a sign.
    [[nodiscard]] MultiplierSet multipliers(const Eigen::VectorXd& gradient, bool with_sphere,
                                            bool banded = false) const;
    /// -gradient on T, within the sphere if asked, by its length over |gradient|.
    [[nodiscard]] Magnitude descends(const Eigen::VectorXd& gradient, bool with_sphere) const;
    [[nodiscard]] Eigen::MatrixXd flat(const std::vector<Eigen::Index>& held, bool with_sphere) const;
    [[nodiscard]] Eigen::MatrixXd lagrangian() const;
    [[nodiscard]] Rates rates(const Shift& direction) const;
    [[nodiscard]] MultiplierSet::Greatest greatest(const MultiplierSet& set, const Rates& rate, bool with_sphere) const;
    [[nodiscard]] Side linear_side(const Rates& rate) const;
    [[nodiscard]] Side end_side(const Rates& rate) const;

    const RelaxedSet& set_;
    Objective objective_;
    double level_;
    RelaxedProgram form_;
    MagnitudeBounds magnitude_;
    std::string refusal_;  // empty, or why there are no derivatives
    // The point, with its active rows of the program.
    Eigen::VectorXd x_, gradient_, sphere_;
    std::vector<Eigen::Index> active_;
    Eigen::MatrixXd equalities_, normals_;
    double gradient_scale_ = 1;
    // What is known of it.
    Place place_ = Place::free;
    double descent_ = 0;  // root: length of the projection of -gradient on T within the sphere
    std::optional<MultiplierSet> multipliers_;
    bool strict_ = false;    // every active row has a positive multiplier
    bool isolated_ = false;  // second-order sufficient condition
};

}  // namespace nsma
