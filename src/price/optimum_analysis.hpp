#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "multiplier_set.hpp"
#include "relaxed_program.hpp"
#include "nsma/price/shadow_prices.hpp"

namespace nsma {

/// Change of the optimal value to one side, in the scale of the program.
struct Side {
    enum class Status {
        finite,      ///< V(t) - V(0) = value t + o(t)
        infeasible,  ///< no orbit nearby
        root,        ///< V(t) - V(0) = value sqrt(t) + O(t)
        refused
    } status = Status::refused;
    double value = 0;
    std::string reason;
};

/// Rates of the scaled right-hand sides of a program along a direction.
struct Rates {
    Eigen::VectorXd equality;  ///< of COND2 (size 1 or 0)
    Eigen::VectorXd rows;      ///< of the active inequalities
    double sphere = 0;
    double band = 0;  ///< half width of COND2's band, >= 0

    [[nodiscard]] bool nothing() const { return equality.isZero(0) && rows.isZero(0) && sphere == 0 && band == 0; }
};

/// One optimum over x = beta/scale: its active rows, its multipliers and what the energy level
/// is there. With A the active normals, E COND2's and s the sphere's, the tangent cone is
/// T = { d: A d <= 0, E d = 0 }.
class OptimumAnalysis {
public:
    /// Where the energy level meets T.
    enum class Place {
        free,    ///< no energy level: a convex program, or a vertex of the greatest energy
        inside,  ///< the energy grows along some d of T and falls along another
        corner,  ///< an end of the energy interval, no d of T keeps the energy: linear growth
        root,    ///< the least energy; the objective falls along some d of T that keeps it
        flat     ///< an end where some d of T keeps energy and objective: second order decides
    };

    OptimumAnalysis(const RelaxedSet& set, Objective objective, std::optional<double> level,
                    const Eigen::VectorXd& start, const MagnitudeBounds& magnitude, const Eigen::VectorXd& reference);

    [[nodiscard]] Rates rates(const Shift& direction) const;
    /// Derivative of the optimal value to the side of `direction`, reported units.
    [[nodiscard]] Side side(const Shift& direction) const;
    /// Derivative of beta by the implicit function theorem on the active set.
    [[nodiscard]] OrbitSlope orbit_slope(const Shift& direction) const;
    [[nodiscard]] std::optional<double> euler_defect() const;

    const RelaxedSet& set;
    Objective objective;
    double level = 0;
    RelaxedProgram form;
    Eigen::VectorXd x, beta;
    double value = 0;                    ///< reported
    std::vector<Eigen::Index> active;    ///< rows of the program
    std::string refusal;                 ///< empty, or why there are no derivatives
    std::optional<double> kkt_residual;  ///< relative; absent where there are no multipliers
    bool unique = false;                 ///< one vector of multipliers
    bool strict = false;                 ///< every active row has a positive multiplier
    bool isolated = false;               ///< second-order sufficient condition

private:
    [[nodiscard]] bool settle();
    void set_point(const Eigen::VectorXd& point);
    void find_active();
    void find_place();
    void find_multipliers();
    void newton_step();
    [[nodiscard]] bool second_order(const std::vector<Eigen::Index>& held);
    [[nodiscard]] Eigen::MatrixXd held_flat(const std::vector<Eigen::Index>& held, bool with_sphere) const;
    [[nodiscard]] Eigen::MatrixXd lagrangian() const;
    [[nodiscard]] MultiplierSet energy_multipliers(double sign, bool banded) const;
    [[nodiscard]] MultiplierSet multipliers(bool banded) const;
    [[nodiscard]] Side end_side(const Rates& rate) const;
    [[nodiscard]] Side linear_side(const Rates& rate) const;

    MagnitudeBounds magnitude_;
    bool has_sphere_ = false;
    Eigen::MatrixXd equalities_, normals_;
    Eigen::VectorXd gradient_, sphere_;
    double gradient_scale_ = 1;
    Place place_ = Place::free;
    Eigen::VectorXd y_, nu_;
    double mu_ = 0;
    double descent_ = 0;  // root: length of the projection of -gradient on T within the sphere
};

}  // namespace nsma
