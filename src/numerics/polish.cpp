#include "polish.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "boundary.hpp"
#include "least_squares.hpp"

namespace nsma {
namespace {

constexpr int halvings_limit = 40;
constexpr double objective_rounding = 1e-15;  // relative to 1 + |f|: a few units in the last place
constexpr double sphere_rounding = 1e-14;  // of its equation and COND2's, sums of up to some hundred terms of order one
constexpr double support_rounding = 1e-13;   // relative; rows are scaled to order one
constexpr double nearly_active = 1e-6;       // slack from which descent no longer comes to a row by itself
constexpr double curvature_rounding = 1e-9;  // relative; a flat direction is no way down
constexpr double escape_decrease = 1e-12;    // relative to 1 + |f|: more than rounding
constexpr int escape_halvings = 12;

// Multipliers at x and the projection of -gradient on the tangent cone of its active rows.
struct FirstOrder {
    Multipliers multipliers;
    Eigen::VectorXd direction;
    std::vector<Row> supporting;  // active rows with a positive multiplier, independent
};

// Least squares over all columns where that is nonnegative already: every active row pushes back, the usual case at the
// end of a descent, for which adding columns one by one would take their number of decompositions.
std::optional<NonnegativeSolution> all_supporting(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target) {
    if (matrix.cols() == 0 || matrix.cols() > matrix.rows()) return std::nullopt;
    NonnegativeSolution solution;
    solution.y = least_squares(matrix, target);
    solution.residual = target - matrix * solution.y;
    const double orthogonal = support_rounding * target.norm();  // dependent columns leave more
    if (!solution.y.allFinite() || solution.y.minCoeff() <= 0 ||
        (matrix.transpose() * solution.residual).cwiseAbs().maxCoeff() > orthogonal)
        return std::nullopt;
    for (int k = 0; k < matrix.cols(); ++k) solution.support.push_back(k);
    solution.converged = true;
    return solution;
}

FirstOrder first_order(const Program& program, const Boundary& boundary, const std::vector<Row>& active,
                       const Eigen::VectorXd& x) {
    const auto n = program.variables();
    const auto equality_count = program.equalities.rows();
    const bool sphere = program.sphere_variables > 0;
    Eigen::MatrixXd smooth(equality_count + (sphere ? 1 : 0), n);
    smooth.topRows(equality_count) = Eigen::MatrixXd(program.equalities);
    if (sphere) smooth.row(equality_count) = 2.0 * boundary.on_sphere(x).transpose();
    const Eigen::MatrixXd basis = null_space(smooth, n);

    const Eigen::VectorXd gradient = program.objective_gradient(x);
    const Eigen::MatrixXd normals = boundary.normals(active);
    const Eigen::MatrixXd pushes = (normals * basis).transpose();
    const Eigen::VectorXd pull = -(basis.transpose() * gradient);
    auto together = all_supporting(pushes, pull);
    const NonnegativeSolution solution = together ? std::move(*together) : nonnegative_least_squares(pushes, pull);

    FirstOrder result;
    result.direction = basis * solution.residual;
    auto& multipliers = result.multipliers;
    multipliers.inequality = Eigen::VectorXd::Zero(program.inequalities.rows());
    multipliers.lower = Eigen::VectorXd::Zero(n);
    multipliers.upper = Eigen::VectorXd::Zero(n);
    for (const int k : solution.support) {
        const Row& row = active[static_cast<std::size_t>(k)];
        auto& target = row.kind == Kind::inequality ? multipliers.inequality
                       : row.kind == Kind::lower    ? multipliers.lower
                                                    : multipliers.upper;
        target[row.index] = solution.y[k];
        result.supporting.push_back(row);
    }
    Eigen::VectorXd balance = gradient + normals.transpose() * solution.y;
    multipliers.equality = Eigen::VectorXd::Zero(equality_count);
    if (smooth.rows() > 0) {
        const Eigen::VectorXd smooth_multipliers = MinimumNorm(smooth.transpose()).solve(-balance);
        multipliers.equality = smooth_multipliers.head(equality_count);
        if (sphere) multipliers.sphere = smooth_multipliers[equality_count];
        balance += smooth.transpose() * smooth_multipliers;
    }
    multipliers.residual = balance.norm() / (1.0 + gradient.norm());
    return result;
}

// Directions along x + span(basis) and the sphere, and the Hessian of the Lagrangian on them.
struct Tangent {
    Eigen::MatrixXd span;  // orthonormal columns
    Eigen::MatrixXd hessian;
};

Tangent tangent_of(const Program& program, const Boundary& boundary, const Eigen::MatrixXd& basis,
                   const Eigen::VectorXd& x, double sphere_multiplier) {
    const auto k = basis.cols();
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Identity(k, k);
    Eigen::MatrixXd hessian = basis.transpose() * (program.hessian * basis);
    if (program.sphere_variables > 0) {
        const Eigen::MatrixXd top = basis.topRows(program.sphere_variables);
        hessian += 2.0 * sphere_multiplier * (top.transpose() * top);
        tangent = null_space((basis.transpose() * boundary.on_sphere(x)).transpose(), k);
    }
    return {basis * tangent, tangent.transpose() * hessian * tangent};
}

// What rounding does to the objective between two points of the sphere: its own, and the multiplier
// times what the sphere's equation is off by, the larger part where the sphere hardly cuts the
// flat (close to E_min).
double rounding_between(const Program& program, double sphere_multiplier, const Polished& at,
                        const Eigen::VectorXd& x) {
    const double own =
        objective_rounding * (1.0 + std::abs(at.objective)) + sphere_rounding * std::abs(sphere_multiplier);
    if (program.sphere_variables == 0) return own;
    return own + std::abs(sphere_multiplier * (program.sphere_residual(x) - program.sphere_residual(at.x)));
}

// Newton direction of the KKT system on x + span(basis) with the sphere, or the given descent
// direction where the system is not positive definite along the sphere.
Eigen::VectorXd newton_direction(const Program& program, const Boundary& boundary, const Eigen::MatrixXd& basis,
                                 const Eigen::VectorXd& x, double sphere_multiplier, const Eigen::VectorXd& descent) {
    const auto [span, reduced] = tangent_of(program, boundary, basis, x, sphere_multiplier);
    if (span.cols() == 0) return Eigen::VectorXd::Zero(x.size());  // a point: nothing to reduce over
    const Eigen::VectorXd gradient = span.transpose() * program.objective_gradient(x);
    if (const auto step = solve_definite(reduced, -gradient)) return span * *step;
    const Eigen::VectorXd along = span * (span.transpose() * descent);
    const double curvature =
        along.norm() > 0 ? along.dot(program.hessian * along + 2.0 * sphere_multiplier * boundary.on_sphere(along))
                         : 0.0;
    // Exact minimiser along the line where the curvature allows, else a bold step.
    if (curvature > 1e-12 * along.squaredNorm()) return along * (along.squaredNorm() / curvature);
    return along * (0.5 / std::max(along.norm(), 1e-300));
}

// Direction along the active rows in which a stationary point is a maximum or saddle: that of the
// least curvature of the Lagrangian; size 0 where no curvature is negative.
Eigen::VectorXd escape_direction(const Program& program, const Boundary& boundary, const std::vector<Row>& active,
                                 const Eigen::VectorXd& x, double sphere_multiplier) {
    const Eigen::MatrixXd basis = boundary.directions(active);
    const auto [span, hessian] = tangent_of(program, boundary, basis, x, sphere_multiplier);
    if (span.cols() == 0) return {};
    const auto [curvatures, modes] = spectrum(hessian);
    if (curvatures[0] >= -curvature_rounding * curvatures.cwiseAbs().maxCoeff()) return {};
    return span * modes.col(0);
}

// Leaves a stationary point that is no minimum along its active rows; false at a minimum.
bool escaped(const Program& program, const Boundary& boundary, const std::vector<Row>& active, double sphere_multiplier,
             const PolishOptions& options, Polished& result) {
    const Eigen::VectorXd direction = escape_direction(program, boundary, active, result.x, sphere_multiplier);
    if (direction.size() == 0) return false;
    const Eigen::MatrixXd basis = boundary.directions(active);
    for (const double side : {0.5, -0.5}) {  // half the radius of the sphere
        std::vector<Row> blocking;
        double step = boundary.step_to_boundary(result.x, side * direction, 1e-14, blocking);
        for (int halving = 0; halving < escape_halvings; ++halving, step *= 0.5) {
            Eigen::VectorXd x = boundary.project(active, result.x + step * side * direction);
            if (!boundary.retract(basis, x) || program.violation(x) > options.feasibility) continue;
            const double objective = program.objective(x);
            if (objective >= result.objective - escape_decrease * (1.0 + std::abs(result.objective))) continue;
            result.x = std::move(x);
            result.objective = objective;
            return true;
        }
    }
    return false;
}

// |L(x) - f(x)| at most: what the multipliers make of the rounding by which x misses its equalities and active rows.
double multiplied_slack(const Program& program, const Eigen::VectorXd& x, const Multipliers& multipliers) {
    double sum = std::abs(multipliers.sphere * program.sphere_residual(x));
    if (program.equalities.rows() > 0) {
        sum += multipliers.equality.cwiseAbs().dot((program.equalities * x - program.equality_values).cwiseAbs());
    }
    if (program.inequalities.rows() > 0) {
        sum += multipliers.inequality.dot((program.inequality_values - program.inequalities * x).cwiseAbs());
    }
    for (Eigen::Index j = 0; j < x.size(); ++j) {
        if (multipliers.lower[j] > 0) sum += multipliers.lower[j] * std::abs(x[j] - program.lower[j]);
        if (multipliers.upper[j] > 0) sum += multipliers.upper[j] * std::abs(program.upper[j] - x[j]);
    }
    return sum;
}

// Best bound inf L over the flat of the equalities, over the sphere's multiplier only.
double dual_bound(const Program& program, const Boundary& boundary, const Eigen::VectorXd& x,
                  const Multipliers& multipliers, double objective) {
    const Eigen::MatrixXd basis = null_space(Eigen::MatrixXd(program.equalities), program.variables());
    const double slip = 2.0 * multipliers.residual * (1.0 + program.objective_gradient(x).norm()) +
                        multiplied_slack(program, x, multipliers);
    if (basis.cols() == 0) return objective;
    if (program.sphere_variables < program.variables()) {
        // Not every unknown lies on the sphere: only a convex Lagrangian gives a bound.
        Eigen::MatrixXd hessian = Eigen::MatrixXd(program.hessian);
        hessian.diagonal().head(program.sphere_variables).array() += 2.0 * multipliers.sphere;
        const Eigen::VectorXd curvatures = eigenvalues(basis.transpose() * hessian * basis);
        return curvatures[0] >= -1e-12 * (1.0 + curvatures.cwiseAbs().maxCoeff()) ? objective - slip : -no_bound;
    }
    const auto [curvatures, modes] = spectrum(basis.transpose() * (program.hessian * basis));
    const Eigen::VectorXd shifted = curvatures.array() + 2.0 * multipliers.sphere;
    if (shifted[0] >= 0) return objective - slip;
    const Eigen::VectorXd c = modes.transpose() * (basis.transpose() * boundary.on_sphere(x));
    // inf over the flat of L with multiplier mu + s is objective - 2 s^2 sum c_i^2/(l_i + 2 s),
    // concave in s > -l_min/2: golden section on a logarithmic scale of s + l_min/2.
    const auto bound = [&](double excess) {
        const double s = -0.5 * shifted[0] + excess;
        double sum = 0;
        for (Eigen::Index i = 0; i < c.size(); ++i) {
            sum += c[i] * c[i] / std::max(shifted[i] + 2.0 * s, 1e-300);
        }
        return objective - 2.0 * s * s * sum;
    };
    double best = -no_bound;
    const double scale = shifted.cwiseAbs().maxCoeff();
    for (int i = -120; i <= 20; ++i) best = std::max(best, bound(scale * std::pow(10.0, 0.1 * i)));
    return best - slip;
}

}  // namespace

Polished polish(const Program& program, const Eigen::VectorXd& start, const PolishOptions& options) {
    Polished result;
    result.x = start;
    if (start.size() != program.variables() || !start.allFinite()) return result;
    const Boundary boundary(program);
    // Clean the start: its active rows hold exactly, and it lies on the sphere.
    {
        const auto rows = boundary.active(start, options.activity);
        Eigen::VectorXd x = boundary.project(rows, start);
        if (boundary.retract(boundary.directions(rows), x) &&
            program.violation(x) <= std::max(options.feasibility, program.violation(start))) {
            result.x = std::move(x);
        }
    }
    result.objective = program.objective(result.x);
    FirstOrder order;
    for (; result.steps < options.max_steps; ++result.steps) {
        const auto active = boundary.active(result.x, options.activity);
        order = first_order(program, boundary, active, result.x);
        const double gradient_scale = 1.0 + program.objective_gradient(result.x).norm();
        if (order.direction.norm() <= 1e-3 * options.stationarity * gradient_scale) {
            if (!escaped(program, boundary, active, order.multipliers.sphere, options, result)) break;
            continue;
        }

        // Rows that the projected gradient leaves may be left; the others hold.
        std::vector<Row> working;
        for (const auto& row : active) {
            const double rate = boundary.normal(row).dot(order.direction);
            const double rounding = 1e-9 * order.direction.norm() + 1e-14 * gradient_scale;
            if (rate >= -rounding) working.push_back(row);
        }
        const Eigen::MatrixXd basis = boundary.directions(working);
        bool moved = false;
        for (const bool newton : {true, false}) {
            Eigen::VectorXd direction =
                newton ? newton_direction(program, boundary, basis, result.x, order.multipliers.sphere, order.direction)
                       : Eigen::VectorXd(basis * (basis.transpose() * order.direction));
            if (program.objective_gradient(result.x).dot(direction) >= 0) continue;
            std::vector<Row> blocked = working;
            double step = boundary.step_to_boundary(result.x, direction, 1e-14 * direction.norm(), blocked);
            for (int halving = 0; halving < halvings_limit && !moved; ++halving) {
                const auto& rows = halving == 0 ? blocked : working;
                Eigen::VectorXd x = boundary.project(rows, result.x + step * direction);
                if (boundary.retract(boundary.directions(rows), x) && program.violation(x) <= options.feasibility) {
                    const double objective = program.objective(x);
                    const double rounding = rounding_between(program, order.multipliers.sphere, result, x);
                    // Closer than the root of rounding to an optimum the objective shows no
                    // progress: there a full Newton step is judged by what it leaves of the slope.
                    const auto slope_halved = [&] {
                        return newton && halving == 0 && objective <= result.objective + rounding &&
                               first_order(program, boundary, boundary.active(x, options.activity), x)
                                       .direction.norm() <= 0.5 * order.direction.norm();
                    };
                    if (objective < result.objective - rounding || slope_halved()) {
                        moved = true;
                        result.x = std::move(x);
                        result.objective = objective;
                    }
                }
                step *= 0.5;
            }
            if (moved) break;
        }
        if (!moved) break;
    }
    if (result.steps >= options.max_steps) {  // those of the last point are one step behind
        order = first_order(program, boundary, boundary.active(result.x, options.activity), result.x);
    }
    // Where the sphere passes through a vertex, descent along its edges only creeps towards it: rows that are almost
    // active are tried as active.
    for (double near = 1e2 * options.activity; near <= nearly_active; near *= 10) {
        if (order.multipliers.residual <= options.stationarity) break;
        const auto rows = boundary.active(result.x, near);
        Eigen::VectorXd x = boundary.project(rows, result.x);
        if (!boundary.retract(boundary.directions(rows), x) || program.violation(x) > options.feasibility) continue;
        FirstOrder there = first_order(program, boundary, boundary.active(x, options.activity), x);
        if (there.multipliers.residual > options.stationarity) continue;
        result.x = std::move(x);
        result.objective = program.objective(result.x);
        order = std::move(there);
    }
    result.feasible = program.violation(result.x) <= options.feasibility;
    result.multipliers = order.multipliers;
    result.stationary = result.feasible && order.multipliers.residual <= options.stationarity;
    if (result.stationary) {
        result.lower_bound = dual_bound(program, boundary, result.x, result.multipliers, result.objective);
    }
    return result;
}

}  // namespace nsma
