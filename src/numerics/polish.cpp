#include "polish.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "boundary.hpp"
#include "decompositions.hpp"
#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

constexpr double feasibility = PolishOptions::feasibility;
constexpr double stationarity = PolishOptions::stationarity;
constexpr double activity = PolishOptions::activity;
constexpr int steps_limit = 200;
constexpr int halvings_limit = 40;
constexpr double objective_rounding = 1e-15;  // relative to 1 + |f|: a few units in the last place
constexpr double sphere_rounding = 1e-14;  // of its equation and COND2's, sums of up to some hundred terms of order one
constexpr double nearly_active = 1e-6;     // slack from which descent no longer comes to a row by itself
constexpr double curvature_rounding = 1e-9;  // relative; a flat direction is no way down
constexpr double escape_decrease = 1e-12;    // relative to 1 + |f|: more than rounding
constexpr int escape_halvings = 12;

// Directions along x + span(basis) and the sphere, and the Hessian of the Lagrangian on them.
struct Tangent {
    Eigen::MatrixXd span;  // orthonormal columns
    Eigen::MatrixXd hessian;
};

// Active-set descent from one start; the point and its first order conditions are kept together.
class Descent {
public:
    Descent(const Program& program, const Eigen::VectorXd& start)
        : program_(program), boundary_(program), x_(start), objective_(program.objective(start)) {}

    Polished run() {
        clean_start();
        Polished result;
        for (; result.steps < steps_limit; ++result.steps) {
            stop_point();
            active_ = boundary_.active(x_, activity);
            order_ = first_order(boundary_, active_, x_);
            gradient_ = program_.objective_gradient(x_);
            const double slope = order_.direction.norm();
            if (!(slope <= 1e-3 * stationarity * (1.0 + gradient_.norm()) ? leave_saddle() : step_down())) break;
        }
        if (result.steps >= steps_limit) order_ = order_at(x_);  // that of the last point is one step behind
        settle_on_nearly_active_rows();
        result.x = x_;
        result.objective = objective_;
        result.feasible = program_.violation(x_) <= feasibility;
        result.multipliers = order_.multipliers;
        result.stationary = result.feasible && order_.multipliers.residual <= stationarity;
        if (result.stationary) result.lower_bound = dual_bound(boundary_, x_, order_.multipliers);
        return result;
    }

private:
    [[nodiscard]] FirstOrder order_at(const Eigen::VectorXd& x) const {
        return first_order(boundary_, boundary_.active(x, activity), x);
    }

    // The point near x on which `rows`, the equalities and the sphere hold, where it is feasible.
    [[nodiscard]] std::optional<Eigen::VectorXd> moved_onto(const std::vector<Row>& rows, const Eigen::VectorXd& x,
                                                            double violation = feasibility) const {
        Eigen::VectorXd moved = boundary_.project(rows, x);
        if (!boundary_.retract(boundary_.directions(rows), moved) || program_.violation(moved) > violation)
            return std::nullopt;
        return moved;
    }

    void move_to(Eigen::VectorXd x) {
        x_ = std::move(x);
        objective_ = program_.objective(x_);
    }

    // The active rows of the start hold exactly, and it lies on the sphere.
    void clean_start() {
        if (auto x = moved_onto(boundary_.active(x_, activity), x_, std::max(feasibility, program_.violation(x_))))
            move_to(std::move(*x));
    }

    // One step with a lower objective, Newton's or else of steepest descent; false where there is none.
    bool step_down() {
        // Rows that the projected gradient leaves may be left; the others hold.
        const double rounding = 1e-9 * order_.direction.norm() + 1e-14 * (1.0 + gradient_.norm());
        std::vector<Row> working;
        for (const auto& row : active_) {
            if (boundary_.along(row, order_.direction) >= -rounding) working.push_back(row);
        }
        const Eigen::MatrixXd basis = boundary_.directions(working);
        return step_along(newton_direction(basis), working, true) ||
               step_along(basis * (basis.transpose() * order_.direction), working, false);
    }

    bool step_along(const Eigen::VectorXd& direction, const std::vector<Row>& working, bool newton) {
        if (gradient_.dot(direction) >= 0) return false;
        std::vector<Row> blocked = working;
        const double longest = boundary_.step_to_boundary(x_, direction, 1e-14 * direction.norm(), blocked);
        for (int halving = 0; halving < halvings_limit; ++halving) {
            stop_point();
            const double step = std::ldexp(longest, -halving);
            const auto x = moved_onto(halving == 0 ? blocked : working, x_ + step * direction);
            if (!x || !is_progress(*x, newton && halving == 0)) continue;
            move_to(*x);
            return true;
        }
        return false;
    }

    [[nodiscard]] bool is_progress(const Eigen::VectorXd& x, bool full_newton_step) const {
        const double objective = program_.objective(x);
        const double rounding = rounding_to(x);
        if (objective < objective_ - rounding) return true;
        // Closer than the root of rounding to an optimum the objective shows no progress: there a full Newton step is
        // judged by what it leaves of the slope.
        return full_newton_step && objective <= objective_ + rounding &&
               order_at(x).direction.norm() <= 0.5 * order_.direction.norm();
    }

    // What rounding does to the objective between two points of the sphere: its own, and the multiplier times what the
    // sphere's equation is off by, the larger part where the sphere hardly cuts the flat (close to E_min).
    [[nodiscard]] double rounding_to(const Eigen::VectorXd& x) const {
        const double multiplier = std::abs(order_.multipliers.sphere);
        const double own = objective_rounding * (1.0 + std::abs(objective_)) + sphere_rounding * multiplier;
        if (program_.sphere_variables == 0) return own;
        return own + multiplier * std::abs(program_.sphere_residual(x) - program_.sphere_residual(x_));
    }

    [[nodiscard]] Tangent tangent_of(const Eigen::MatrixXd& basis) const {
        const auto k = basis.cols();
        Eigen::MatrixXd tangent = Eigen::MatrixXd::Identity(k, k);
        Eigen::MatrixXd hessian = basis.transpose() * (program_.hessian * basis);
        if (program_.sphere_variables > 0) {
            const Eigen::MatrixXd top = basis.topRows(program_.sphere_variables);
            hessian += 2.0 * order_.multipliers.sphere * (top.transpose() * top);
            tangent = null_space((basis.transpose() * boundary_.on_sphere(x_)).transpose(), k);
        }
        return {basis * tangent, tangent.transpose() * hessian * tangent};
    }

    // Newton direction of the KKT system on x + span(basis) with the sphere, or that of steepest descent where the
    // system is not positive definite along the sphere.
    [[nodiscard]] Eigen::VectorXd newton_direction(const Eigen::MatrixXd& basis) const {
        const auto [span, reduced] = tangent_of(basis);
        if (span.cols() == 0) return Eigen::VectorXd::Zero(x_.size());  // a point: nothing to reduce over
        if (const auto step = solve_definite(reduced, -(span.transpose() * gradient_))) return span * *step;
        const Eigen::VectorXd along = span * (span.transpose() * order_.direction);
        const double mu = order_.multipliers.sphere;
        const double curvature =
            along.norm() > 0 ? along.dot(program_.hessian * along + 2.0 * mu * boundary_.on_sphere(along)) : 0.0;
        // Exact minimiser along the line where the curvature allows, else a bold step.
        if (curvature > 1e-12 * along.squaredNorm()) return along * (along.squaredNorm() / curvature);
        return along * (0.5 / std::max(along.norm(), 1e-300));
    }

    // Leaves a stationary point that is no minimum along its active rows, in the direction of the least curvature of
    // the Lagrangian; false at a minimum.
    bool leave_saddle() {
        const auto [span, hessian] = tangent_of(boundary_.directions(active_));
        if (span.cols() == 0) return false;
        const auto [curvatures, modes] = spectrum(hessian);
        if (curvatures[0] >= -curvature_rounding * curvatures.cwiseAbs().maxCoeff()) return false;
        for (const double side : {0.5, -0.5}) {  // half the radius of the sphere
            const Eigen::VectorXd direction = side * (span * modes.col(0));
            std::vector<Row> blocking;
            const double longest = boundary_.step_to_boundary(x_, direction, 1e-14, blocking);
            for (int halving = 0; halving < escape_halvings; ++halving) {
                stop_point();
                const auto x = moved_onto(active_, x_ + std::ldexp(longest, -halving) * direction);
                if (!x || program_.objective(*x) >= objective_ - escape_decrease * (1.0 + std::abs(objective_)))
                    continue;
                move_to(*x);
                return true;
            }
        }
        return false;
    }

    // Where the sphere passes through a vertex, descent along its edges only creeps towards it: rows that are almost
    // active are tried as active.
    void settle_on_nearly_active_rows() {
        double near = 1e1 * activity;
        while ((near *= 10) <= nearly_active) {
            if (order_.multipliers.residual <= stationarity) return;
            const auto x = moved_onto(boundary_.active(x_, near), x_);
            if (!x) continue;
            FirstOrder there = order_at(*x);
            if (there.multipliers.residual > stationarity) continue;
            move_to(*x);
            order_ = std::move(there);
        }
    }

    const Program& program_;
    Boundary boundary_;
    Eigen::VectorXd x_;
    double objective_;
    // Of the last point from which a step was tried.
    std::vector<Row> active_;
    FirstOrder order_;
    Eigen::VectorXd gradient_;
};

}  // namespace

Polished polish(const Program& program, const Eigen::VectorXd& start) {
    if (start.size() == program.variables() && start.allFinite()) return Descent(program, start).run();
    Polished refused;
    refused.x = start;
    return refused;
}

}  // namespace nsma
