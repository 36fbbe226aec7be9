#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Dense>

/// The best points of small programs over {x >= 0, sum x = s, |x|^2 = q} by looking everywhere: for each set of
/// variables that may be positive every stationary point on its sphere, by the roots of the secular equation between
/// all of its poles. Shares no idea with the closed forms: no order of the variables, no shape of the optimum.
namespace reference {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Best {
    double value = std::numeric_limits<double>::infinity();
    std::vector<VectorXd> points;  ///< of all that tie, and maybe others
};

/// Every stationary point of x'Ax + 2 c.x on {sum x = s (unless s = 0: no such condition), |x|^2 = q}.
inline std::vector<VectorXd> stationary_points(const MatrixXd& a, const VectorXd& c, double s, double q) {
    const Index n = a.rows();
    VectorXd centre = VectorXd::Zero(n);
    MatrixXd basis = MatrixXd::Identity(n, n);
    if (s != 0) {
        centre.setConstant(s / static_cast<double>(n));
        const MatrixXd ones = VectorXd::Ones(n);
        const Eigen::HouseholderQR<MatrixXd> qr(ones);
        basis = (MatrixXd(qr.householderQ())).rightCols(n - 1);
    }
    const double radius = q - centre.squaredNorm();
    std::vector<VectorXd> points;
    if (radius < 0) return points;
    if (basis.cols() == 0) {
        if (radius <= 1e-12 * q) points.push_back(centre);
        return points;
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(basis.transpose() * a * basis);
    const VectorXd& d = spectrum.eigenvalues();
    const VectorXd g = spectrum.eigenvectors().transpose() * (basis.transpose() * (a * centre + c));
    const double scale = 1 + g.cwiseAbs().maxCoeff() + d.cwiseAbs().maxCoeff();
    const auto add = [&](const VectorXd& y) {
        if (!y.allFinite() || std::abs(y.squaredNorm() - radius) > 1e-9 * (1e-3 * q + radius)) return;
        points.push_back(centre + basis * (spectrum.eigenvectors() * y));
    };
    // (d + mu) y = -g with |y|^2 = radius. Where g has no part in an eigenspace mu = -d is possible, with any part
    // there.
    for (Index i = 0; i < d.size(); ++i) {
        bool free_part = true;
        VectorXd y(d.size());
        for (Index k = 0; k < d.size(); ++k) {
            const bool same = std::abs(d[k] - d[i]) <= 1e-9 * scale;
            if (same && std::abs(g[k]) > 1e-9 * scale) free_part = false;
            y[k] = same ? 0.0 : -g[k] / (d[k] - d[i]);
        }
        const double left = radius - y.squaredNorm();
        if (!free_part || left < 0) continue;
        for (const double side : {1.0, -1.0}) {
            VectorXd whole = y;
            whole[i] += side * std::sqrt(left);
            add(whole);
        }
    }
    const auto excess = [&](double mu) { return (g.array() / (d.array() + mu)).square().sum() - radius; };
    std::vector<double> ends{-d.maxCoeff() - 1e3 * scale / std::sqrt(radius + 1e-300)};
    for (Index k = d.size() - 1; k >= 0; --k) {
        if (-d[k] > ends.back() + 1e-11 * scale) ends.push_back(-d[k]);
    }
    ends.push_back(-d.minCoeff() + 1e3 * scale / std::sqrt(radius + 1e-300));
    constexpr int samples = 400;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        double before = 0, at_before = 0;
        for (int i = 1; i < samples; ++i) {
            // Denser toward the poles: both ends of the interval, but for the outermost two.
            const double at = static_cast<double>(i) / samples;
            double share = 0.5 * (1 + std::tanh(16.0 * (at - 0.5)));
            if (k + 2 == ends.size()) share = std::pow(10.0, -24 * (1 - at));
            if (k == 0) share = 1 - std::pow(10.0, -16 * at);
            const double mu = ends[k] + (ends[k + 1] - ends[k]) * share;
            const double value = excess(mu);
            if (i > 1 && at_before * value <= 0) {
                double lo = before, hi = mu;
                for (int step = 0; step < 200; ++step) {
                    const double middle = 0.5 * (lo + hi);
                    (excess(middle) * at_before > 0 ? lo : hi) = middle;
                }
                add(-(g.array() / (d.array() + hi)).matrix());
            }
            before = mu;
            at_before = value;
        }
    }
    return points;
}

/// Least x'Ax + 2 c.x over x >= 0 with the sum (unless 0) and the square.
inline Best least(const MatrixXd& a, const VectorXd& c, double s, double q) {
    const auto n = static_cast<int>(a.rows());
    Best best;
    for (unsigned mask = 1; mask < (1U << n); ++mask) {
        std::vector<Index> chosen;
        for (int j = 0; j < n; ++j) {
            if ((mask >> j & 1U) != 0) chosen.push_back(j);
        }
        for (const VectorXd& part : stationary_points(a(chosen, chosen), c(chosen), s, q)) {
            if (part.minCoeff() < -1e-10 * std::sqrt(q)) continue;
            VectorXd x = VectorXd::Zero(n);
            x(chosen) = part;
            const double value = x.dot(a * x) + 2 * c.dot(x);
            best.value = std::min(best.value, value);
            best.points.push_back(std::move(x));
        }
    }
    return best;
}

/// The least bound t for which {0 <= x <= t, sum x = s (unless 0)} reaches |x|^2 = q: its farthest points have only
/// entries 0 and t but for one, and all of them are tried.
inline double least_peak(int n, double s, double q) {
    if (s == 0) return std::sqrt(q / n);
    const auto reach = [&](double t) {
        double farthest = 0;
        for (unsigned mask = 0; mask < (1U << n); ++mask) {
            for (int one = 0; one < n; ++one) {
                if ((mask >> one & 1U) != 0) continue;
                const int full = __builtin_popcount(mask);
                const double rest = s - full * t;
                if (rest < -1e-15 || rest > t * (1 + 1e-15)) continue;
                farthest = std::max(farthest, full * t * t + rest * rest);
            }
        }
        return farthest;
    };
    double lo = s / n, hi = s;
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (lo + hi);
        (reach(middle) < q ? lo : hi) = middle;
    }
    return hi;
}

}  // namespace reference
