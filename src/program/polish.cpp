#include "nsma/program/polish.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "nsma/program/least_squares.hpp"

namespace nsma {
namespace {

constexpr int halvings_limit = 40;
constexpr double objective_rounding = 1e-15;  // relative to 1 + |f|: a few units in the last place
constexpr double nearly_active = 1e-6;  // slack from which descent no longer comes to a row by itself
constexpr double rank_tolerance = 1e-11;  // rows are scaled to order one

enum class Kind { inequality, lower, upper };
struct Row {
    Kind kind;
    Eigen::Index index;
};

// Orthonormal basis of the space orthogonal to the rows of `matrix`.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& matrix, Eigen::Index n) {
    if (matrix.rows() == 0) return Eigen::MatrixXd::Identity(n, n);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix.transpose());
    qr.setThreshold(rank_tolerance);
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(n, n - qr.rank());
    basis.bottomRows(basis.cols()).setIdentity();
    basis.applyOnTheLeft(qr.householderQ().setLength(qr.rank()));
    return basis;
}

// The feasible set as rows a.x <= b, equalities apart, and the moves along its boundary.
class Boundary {
public:
    explicit Boundary(const Program& program)
        : program_(program), equalities_(program.equalities) {}

    [[nodiscard]] double slack(const Row& row, const Eigen::VectorXd& x) const {
        switch (row.kind) {
            case Kind::inequality:
                return program_.inequality_values[row.index] -
                       program_.inequalities.row(row.index).dot(x);
            case Kind::lower: return x[row.index] - program_.lower[row.index];
            default: return program_.upper[row.index] - x[row.index];
        }
    }

    [[nodiscard]] std::vector<Row> active(const Eigen::VectorXd& x, double tolerance) const {
        std::vector<Row> rows;
        for_each_row([&](const Row& row) {
            if (slack(row, x) <= tolerance) rows.push_back(row);
        });
        return rows;
    }

    [[nodiscard]] Eigen::RowVectorXd normal(const Row& row) const {
        const auto n = program_.variables();
        Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(n);
        if (row.kind == Kind::inequality) {
            result = program_.inequalities.row(row.index);
        } else {
            result[row.index] = row.kind == Kind::lower ? -1.0 : 1.0;
        }
        return result;
    }

    [[nodiscard]] Eigen::MatrixXd normals(const std::vector<Row>& rows) const {
        Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), program_.variables());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            result.row(static_cast<Eigen::Index>(i)) = normal(rows[i]);
        }
        return result;
    }

    // Equalities above the normals of `rows`: the flat on which the point may move.
    [[nodiscard]] Eigen::MatrixXd flat(const std::vector<Row>& rows) const {
        Eigen::MatrixXd result(equalities_.rows() + static_cast<Eigen::Index>(rows.size()),
                               program_.variables());
        result.topRows(equalities_.rows()) = equalities_;
        result.bottomRows(static_cast<Eigen::Index>(rows.size())) = normals(rows);
        return result;
    }

    // Nearest point of the flat on which `rows` and the equalities hold exactly.
    [[nodiscard]] Eigen::VectorXd project(const std::vector<Row>& rows, Eigen::VectorXd x) const {
        const Eigen::MatrixXd system = flat(rows);
        if (system.rows() == 0) return x;
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
        decomposition.setThreshold(rank_tolerance);
        decomposition.compute(system);
        for (int pass = 0; pass < 2; ++pass) {
            Eigen::VectorXd defect(system.rows());
            defect.head(equalities_.rows()) = program_.equality_values - equalities_ * x;
            for (std::size_t i = 0; i < rows.size(); ++i) {
                defect[equalities_.rows() + static_cast<Eigen::Index>(i)] = slack(rows[i], x);
            }
            x += decomposition.solve(defect);
        }
        for (const auto& row : rows) {  // bounds hold to the bit
            if (row.kind == Kind::lower) x[row.index] = program_.lower[row.index];
            if (row.kind == Kind::upper) x[row.index] = program_.upper[row.index];
        }
        return x;
    }

    // Moves x back to the sphere within x + span(basis); false where the flat misses it.
    [[nodiscard]] bool retract(const Eigen::MatrixXd& basis, Eigen::VectorXd& x) const {
        if (program_.sphere_variables == 0) return true;
        for (int pass = 0; pass < 3; ++pass) {
            const Eigen::VectorXd radial = basis * (basis.transpose() * on_sphere(x));
            const Eigen::VectorXd w = on_sphere(radial);
            const double a = w.squaredNorm();
            const double b = x.dot(w);
            const double c = program_.sphere_residual(x);
            const double discriminant = b * b - a * c;
            if (a <= 0 || discriminant < 0) return std::abs(c) <= 1e-14;
            // The root near zero of a s^2 + 2 b s + c, without cancellation.
            const double root = b + std::copysign(std::sqrt(discriminant), b);
            if (root == 0) return false;
            x -= (c / root) * radial;
            if (std::abs(c) <= 1e-15) break;
        }
        return std::abs(program_.sphere_residual(x)) <= 1e-13;
    }

    // x with everything off the sphere set to zero: the gradient of the sphere is twice this.
    [[nodiscard]] Eigen::VectorXd on_sphere(Eigen::VectorXd x) const {
        x.tail(x.size() - program_.sphere_variables).setZero();
        return x;
    }

    // Largest t <= 1 for which no row is crossed along x + t direction; blocking row if t < 1.
    double step_to_boundary(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                            double tolerance, std::vector<Row>& blocking) const {
        double step = 1.0;
        Row first{Kind::inequality, -1};
        for_each_row([&](const Row& row) {
            const double rate = row.kind == Kind::inequality
                                    ? program_.inequalities.row(row.index).dot(direction)
                                    : (row.kind == Kind::lower ? -1.0 : 1.0) * direction[row.index];
            if (rate <= tolerance) return;
            const double t = std::max(slack(row, x), 0.0) / rate;
            if (t < step) {
                step = t;
                first = row;
            }
        });
        if (first.index >= 0) blocking.push_back(first);
        return step;
    }

private:
    template <typename Visit>
    void for_each_row(const Visit& visit) const {
        for (Eigen::Index i = 0; i < program_.inequalities.rows(); ++i) visit({Kind::inequality, i});
        for (Eigen::Index j = 0; j < program_.variables(); ++j) {
            if (program_.lower[j] > -no_bound) visit({Kind::lower, j});
            if (program_.upper[j] < no_bound) visit({Kind::upper, j});
        }
    }

    const Program& program_;
    Eigen::MatrixXd equalities_;
};

// Multipliers at x and the projection of -gradient on the tangent cone of its active rows.
struct FirstOrder {
    Multipliers multipliers;
    Eigen::VectorXd direction;
    std::vector<Row> supporting;  // active rows with a positive multiplier, independent
};

FirstOrder first_order(const Program& program, const Boundary& boundary,
                       const std::vector<Row>& active, const Eigen::VectorXd& x) {
    const auto n = program.variables();
    const auto equality_count = program.equalities.rows();
    const bool sphere = program.sphere_variables > 0;
    Eigen::MatrixXd smooth(equality_count + (sphere ? 1 : 0), n);
    smooth.topRows(equality_count) = Eigen::MatrixXd(program.equalities);
    if (sphere) smooth.row(equality_count) = 2.0 * boundary.on_sphere(x).transpose();
    const Eigen::MatrixXd basis = null_space(smooth, n);

    const Eigen::VectorXd gradient = program.objective_gradient(x);
    const Eigen::MatrixXd normals = boundary.normals(active);
    const NonnegativeSolution solution =
        nonnegative_least_squares((normals * basis).transpose(), -(basis.transpose() * gradient));

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
        const Eigen::VectorXd smooth_multipliers =
            smooth.transpose().completeOrthogonalDecomposition().solve(-balance);
        multipliers.equality = smooth_multipliers.head(equality_count);
        if (sphere) multipliers.sphere = smooth_multipliers[equality_count];
        balance += smooth.transpose() * smooth_multipliers;
    }
    multipliers.residual = balance.norm() / (1.0 + gradient.norm());
    return result;
}

// Newton direction of the KKT system on x + span(basis) with the sphere, or the given descent
// direction where the system is not positive definite along the sphere.
Eigen::VectorXd newton_direction(const Program& program, const Boundary& boundary,
                                 const Eigen::MatrixXd& basis, const Eigen::VectorXd& x,
                                 double sphere_multiplier, const Eigen::VectorXd& descent) {
    const auto k = basis.cols();
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Identity(k, k);
    Eigen::MatrixXd hessian = basis.transpose() * (program.hessian * basis);
    if (program.sphere_variables > 0) {
        const Eigen::MatrixXd top = basis.topRows(program.sphere_variables);
        hessian += 2.0 * sphere_multiplier * (top.transpose() * top);
        tangent = null_space((basis.transpose() * boundary.on_sphere(x)).transpose(), k);
    }
    const Eigen::MatrixXd span = basis * tangent;
    if (span.cols() == 0) return Eigen::VectorXd::Zero(x.size());  // a point: nothing to reduce over
    const Eigen::MatrixXd reduced = tangent.transpose() * hessian * tangent;
    const Eigen::LDLT<Eigen::MatrixXd> factor(reduced);
    const Eigen::VectorXd gradient = span.transpose() * program.objective_gradient(x);
    const double scale = std::max(reduced.cwiseAbs().maxCoeff(), 1e-300);
    if (factor.info() == Eigen::Success && (factor.vectorD().array() > 1e-12 * scale).all()) {
        return span * factor.solve(-gradient);
    }
    const Eigen::VectorXd along = span * (span.transpose() * descent);
    const double curvature = along.norm() > 0
        ? along.dot(program.hessian * along + 2.0 * sphere_multiplier * boundary.on_sphere(along))
        : 0.0;
    // Exact minimiser along the line where the curvature allows, else a bold step.
    if (curvature > 1e-12 * along.squaredNorm()) return along * (along.squaredNorm() / curvature);
    return along * (0.5 / std::max(along.norm(), 1e-300));
}

// Best bound inf L over the flat of the equalities, over the sphere's multiplier only.
double dual_bound(const Program& program, const Boundary& boundary, const Eigen::VectorXd& x,
                  const Multipliers& multipliers, double objective) {
    const Eigen::MatrixXd basis = null_space(Eigen::MatrixXd(program.equalities), program.variables());
    const double slip = 2.0 * multipliers.residual * (1.0 + program.objective_gradient(x).norm());
    if (basis.cols() == 0) return objective;
    if (program.sphere_variables < program.variables()) {
        // Not every unknown lies on the sphere: only a convex Lagrangian gives a bound.
        Eigen::MatrixXd hessian = Eigen::MatrixXd(program.hessian);
        hessian.diagonal().head(program.sphere_variables).array() += 2.0 * multipliers.sphere;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(basis.transpose() * hessian * basis);
        const double scale = 1.0 + spectrum.eigenvalues().cwiseAbs().maxCoeff();
        return spectrum.eigenvalues()[0] >= -1e-12 * scale ? objective - slip : -no_bound;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(basis.transpose() *
                                                                  (program.hessian * basis));
    const Eigen::VectorXd eigenvalues = spectrum.eigenvalues().array() + 2.0 * multipliers.sphere;
    if (eigenvalues[0] >= 0) return objective - slip;
    const Eigen::VectorXd c =
        spectrum.eigenvectors().transpose() * (basis.transpose() * boundary.on_sphere(x));
    // inf over the flat of L with multiplier mu + s is objective - 2 s^2 sum c_i^2/(l_i + 2 s),
    // concave in s > -l_min/2: golden section on a logarithmic scale of s + l_min/2.
    const auto bound = [&](double excess) {
        const double s = -0.5 * eigenvalues[0] + excess;
        double sum = 0;
        for (Eigen::Index i = 0; i < c.size(); ++i) {
            sum += c[i] * c[i] / std::max(eigenvalues[i] + 2.0 * s, 1e-300);
        }
        return objective - 2.0 * s * s * sum;
    };
    double best = -no_bound;
    const double scale = eigenvalues.cwiseAbs().maxCoeff();
    for (int i = -120; i <= 20; ++i) best = std::max(best, bound(scale * std::pow(10.0, 0.1 * i)));
    return best - slip;
}

}  // namespace

Polished polish(const Program& program, const Eigen::VectorXd& start, const PolishOptions& options) {
    Polished result;
    result.x = start;
    if (start.size() != program.variables() || !start.allFinite()) return result;
    const Boundary boundary(program);
    const auto n = program.variables();

    // Clean the start: its active rows hold exactly, and it lies on the sphere.
    {
        const auto rows = boundary.active(start, options.activity);
        Eigen::VectorXd x = boundary.project(rows, start);
        if (boundary.retract(null_space(boundary.flat(rows), n), x) &&
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
        if (order.direction.norm() <= 1e-3 * options.stationarity * gradient_scale) break;

        // Rows that the projected gradient leaves may be left; the others hold.
        std::vector<Row> working;
        for (const auto& row : active) {
            const double rate = boundary.normal(row).dot(order.direction);
            const double rounding = 1e-9 * order.direction.norm() + 1e-14 * gradient_scale;
            if (rate >= -rounding) working.push_back(row);
        }
        const Eigen::MatrixXd basis = null_space(boundary.flat(working), n);
        bool moved = false;
        for (const bool newton : {true, false}) {
            Eigen::VectorXd direction =
                newton ? newton_direction(program, boundary, basis, result.x,
                                          order.multipliers.sphere, order.direction)
                       : Eigen::VectorXd(basis * (basis.transpose() * order.direction));
            if (program.objective_gradient(result.x).dot(direction) >= 0) continue;
            std::vector<Row> blocked = working;
            double step = boundary.step_to_boundary(result.x, direction, 1e-14 * direction.norm(), blocked);
            for (int halving = 0; halving < halvings_limit && !moved; ++halving) {
                const auto& rows = halving == 0 ? blocked : working;
                Eigen::VectorXd x = boundary.project(rows, result.x + step * direction);
                if (boundary.retract(null_space(boundary.flat(rows), n), x) &&
                    program.violation(x) <= options.feasibility) {
                    const double objective = program.objective(x);
                    // Closer than the root of rounding to an optimum the objective shows no
                    // progress: there a full Newton step is judged by what it leaves of the slope.
                    const auto slope_halved = [&] {
                        return newton && halving == 0 &&
                               objective <= result.objective +
                                                objective_rounding * (1.0 + std::abs(result.objective)) &&
                               first_order(program, boundary, boundary.active(x, options.activity), x)
                                       .direction.norm() <= 0.5 * order.direction.norm();
                    };
                    if (objective < result.objective || slope_halved()) {
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
    // Where the sphere passes through a vertex, descent along its edges only creeps towards it: rows that are almost
    // active are tried as active.
    for (double near = 1e2 * options.activity; near <= nearly_active; near *= 10) {
        if (order.multipliers.residual <= options.stationarity) break;
        const auto rows = boundary.active(result.x, near);
        Eigen::VectorXd x = boundary.project(rows, result.x);
        if (!boundary.retract(null_space(boundary.flat(rows), n), x) || program.violation(x) > options.feasibility) continue;
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
        result.lower_bound =
            dual_bound(program, boundary, result.x, result.multipliers, result.objective);
    }
    return result;
}

}  // namespace nsma
