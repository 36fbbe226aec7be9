#include "kkt.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "decompositions.hpp"
#include "least_squares.hpp"

namespace nsma {
namespace {

constexpr double support_rounding = 1e-13;  // relative; rows are scaled to order one

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
    return solution;
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

}  // namespace

FirstOrder first_order(const Boundary& boundary, const std::vector<Row>& active, const Eigen::VectorXd& x) {
    const Program& program = boundary.program();
    const auto n = program.variables();
    const auto equality_count = program.equalities.rows();
    const bool sphere = program.sphere_variables > 0;
    Eigen::MatrixXd smooth(equality_count + (sphere ? 1 : 0), n);
    smooth.topRows(equality_count) = boundary.equalities();
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
    for (std::size_t k = 0; k < active.size(); ++k) {
        const Row& row = active[k];
        auto& target = row.kind == Row::Kind::inequality ? multipliers.inequality
                       : row.kind == Row::Kind::lower    ? multipliers.lower
                                                         : multipliers.upper;
        target[row.index] = solution.y[static_cast<Eigen::Index>(k)];
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

double dual_bound(const Boundary& boundary, const Eigen::VectorXd& x, const Multipliers& multipliers) {
    const Program& program = boundary.program();
    const double objective = program.objective(x);
    const Eigen::MatrixXd basis = null_space(boundary.equalities(), program.variables());
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

}  // namespace nsma
