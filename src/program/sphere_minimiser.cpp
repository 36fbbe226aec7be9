#include "sphere_minimiser.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "boundary.hpp"

namespace nsma {
namespace {

constexpr double feasible = 1e-9;       // what a polish takes as a start
constexpr double same_value = 1e-12;    // eigenvalues, relative, that are one
constexpr double no_component = 1e-10;  // of the gradient in the least eigenspace, relative: symmetry makes it zero
constexpr int bisections = 200;

// sigma > 0 with |c_i/(d_i + sigma)| = radius; decreasing in sigma.
double secular_root(const Eigen::VectorXd& c, const Eigen::VectorXd& d, double radius) {
    double lo = 0;
    double hi = c.norm() / radius;
    for (int k = 0; k < bisections && hi - lo > 1e-16 * hi; ++k) {
        const double middle = 0.5 * (lo + hi);
        ((c.array() / (d.array() + middle)).matrix().norm() > radius ? lo : hi) = middle;
    }
    return hi;
}

}  // namespace

std::optional<Eigen::VectorXd> sphere_minimiser(const Program& program) {
    const auto n = program.variables();
    if (program.sphere_variables != n) return std::nullopt;
    const Eigen::MatrixXd equalities(program.equalities);
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(n);
    if (equalities.rows() > 0) centre = equalities.completeOrthogonalDecomposition().solve(program.equality_values);
    const double square = 1.0 - centre.squaredNorm();
    const Eigen::MatrixXd basis = null_space(equalities, n);
    if (square <= 0 || basis.cols() == 0) return std::nullopt;
    const double radius = std::sqrt(square);

    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(basis.transpose() * (program.hessian * basis));
    const Eigen::VectorXd c = spectrum.eigenvectors().transpose() * (basis.transpose() * program.objective_gradient(centre));
    const Eigen::VectorXd d = spectrum.eigenvalues().array() - spectrum.eigenvalues()[0];
    const double scale = std::max(spectrum.eigenvalues().cwiseAbs().maxCoeff(), 1e-300);
    const auto equal = static_cast<Eigen::Index>((d.array() <= same_value * scale).count());
    const auto feasible_point = [&](const Eigen::VectorXd& y) -> std::optional<Eigen::VectorXd> {
        Eigen::VectorXd x = centre + basis * (spectrum.eigenvectors() * y);
        if (program.violation(x) > feasible) return std::nullopt;
        return x;
    };
    // The hard case: the gradient has no part in the least eigenspace and the rest does not reach the sphere.
    if (c.head(equal).norm() <= no_component * (c.norm() + scale * radius)) {
        Eigen::VectorXd y = Eigen::VectorXd::Zero(c.size());
        const auto rest = c.size() - equal;
        y.tail(rest) = -c.tail(rest).cwiseQuotient(d.tail(rest));
        const double left = square - y.squaredNorm();
        if (left >= 0) {
            for (const double side : {1.0, -1.0}) {
                y[0] = side * std::sqrt(left);
                if (auto x = feasible_point(y)) return x;
            }
            return std::nullopt;
        }
    }
    const double sigma = secular_root(c, d, radius);
    return feasible_point(-(c.array() / (d.array() + sigma)).matrix());
}

}  // namespace nsma
