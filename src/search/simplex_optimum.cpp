#include "simplex_optimum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>

namespace nsma {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using std::numbers::pi;

// Beyond this theta n/2 a hump is flat but for its ends, and cosh is better taken relative to its value there.
constexpr double flat_hump = 20.0;

template <class Function>
double root(Function function, double lo, double hi) {
    const double at_lo = function(lo);
    const double at_hi = function(hi);
    if (at_lo == 0 || at_lo * at_hi > 0) return lo;  // rounding at an end of the range
    if (at_hi == 0) return hi;
    std::uintmax_t evaluations = 200;
    const auto [left, right] = boost::math::tools::toms748_solve(
        function, lo, hi, at_lo, at_hi, boost::math::tools::eps_tolerance<double>(52), evaluations);
    return std::abs(function(left)) < std::abs(function(right)) ? left : right;
}

// Humps on k variables in a row, of sum 1, symmetric about their middle: v_j = C(phi_j) - C(h) - closure (C(phi_j) -
// C(h - 1)) with phi_j = j - h, h = (k + 1)/2, and C = cos(theta .) for curvature = theta^2 > 0, cosh for -theta^2.
class Hump {
public:
    Hump(Index size, double closure) : size_(size), half_(0.5 * static_cast<double>(size + 1)), closure_(closure) {}

    // Its distance from the mean 1/k, entry by entry.
    [[nodiscard]] VectorXd deviation(double curvature) const {
        const double theta = std::sqrt(std::abs(curvature));
        const double mean = 1.0 / static_cast<double>(size_);
        if (curvature < 0 && theta * half_ > flat_hump) {
            const VectorXd drop = VectorXd::NullaryExpr(size_, [&](Index j) { return fall(theta, phi(j)); });
            const double sum = drop.sum();
            const double top = 1 - closure_ * fall(theta, half_ - 1);
            const double share = (1 - closure_) / (static_cast<double>(size_) * top - (1 - closure_) * sum);
            return share * (sum * mean - drop.array()).matrix();
        }
        const VectorXd height = VectorXd::NullaryExpr(size_, [&](Index j) {
            return rise(curvature, theta, half_, phi(j)) - closure_ * rise(curvature, theta, half_ - 1, phi(j));
        });
        return (height.array() / height.sum() - mean).matrix();
    }

    // The motion along which the hump begins to lean: sin(theta phi_j).
    [[nodiscard]] VectorXd lean(double theta) const {
        return VectorXd::NullaryExpr(size_, [&](Index j) { return std::sin(theta * phi(j)); });
    }

    // Beyond this theta a symmetric hump is no minimum: it leans.
    [[nodiscard]] double greatest_theta() const {
        const double n = static_cast<double>(size_);
        if (closure_ == 0) return 2 * pi / (n + 1);
        return root([&](double t) { return std::sin(t * half_) + closure_ * std::sin(t * (half_ - 1)); }, pi / n,
                    2 * pi / n);
    }

    // theta of the least eigenvector cos(theta phi_j), which a cone's best point follows.
    [[nodiscard]] double least_theta() const {
        return root([&](double t) { return std::cos(t * half_) - closure_ * std::cos(t * (half_ - 1)); }, 0.0,
                    pi / static_cast<double>(size_));
    }
    [[nodiscard]] VectorXd least_eigenvector() const {
        const double theta = least_theta();
        return VectorXd::NullaryExpr(size_, [&](Index j) { return std::cos(theta * phi(j)); });
    }

private:
    [[nodiscard]] double phi(Index j) const { return static_cast<double>(j + 1) - half_; }

    // C(phi) - C(end) up to a positive factor that all share.
    static double rise(double curvature, double theta, double end, double phi) {
        const double a = 0.5 * theta * (end + phi);
        const double b = 0.5 * theta * (end - phi);
        if (curvature > 0) return std::sin(a) * std::sin(b);
        return curvature < 0 ? std::sinh(a) * std::sinh(b) : (end + phi) * (end - phi);
    }
    // cosh(theta phi)/cosh(theta h).
    [[nodiscard]] double fall(double theta, double phi) const {
        const double p = std::exp(-theta * (half_ + phi));
        const double q = std::exp(-theta * (half_ - phi));
        return (p + q) / (1 + p * q);
    }

    Index size_;
    double half_;
    double closure_;
};

// Variance of a hump on k variables where its leaning ends because an end entry is zero.
double variance_at_end(Index size, double greatest_theta) {
    const Index rest = size - 1;
    const VectorXd deviation = Hump(rest, 0.0).deviation(greatest_theta * greatest_theta);
    return deviation.squaredNorm() + 1.0 / static_cast<double>(rest) - 1.0 / static_cast<double>(size);
}

// The hump on k variables of sum 1 and |x|^2 = square, which it can have.
VectorXd hump(Index size, double closure, double square) {
    const double mean = 1.0 / static_cast<double>(size);
    const double variance = square - mean;
    if (size == 1 || variance <= 0) return VectorXd::Constant(size, mean);
    const Hump shape(size, closure);
    const double theta = shape.greatest_theta();
    const auto excess = [&](double curvature) { return shape.deviation(curvature).squaredNorm() - variance; };
    const double greatest = theta * theta;
    const double left = -excess(greatest);
    VectorXd deviation;
    if (left > 0) {
        const VectorXd lean = shape.lean(theta);
        deviation = shape.deviation(greatest) + std::sqrt(left / lean.squaredNorm()) * lean;
    } else {
        double least = -greatest;
        while (excess(least) > 0) least *= 4;
        deviation = shape.deviation(root(excess, least, greatest));
    }
    // Rounding of the root, and of an end entry that is zero.
    deviation *= std::sqrt(variance / deviation.squaredNorm());
    return (deviation.array() + mean).max(0.0).matrix();
}

// The greatest number of variables in a row on which a hump of that |x|^2 is nowhere negative.
Index hump_size(Index size, double closure, double square) {
    const auto fits = [&](Index k, double theta) {
        return square - 1.0 / static_cast<double>(k) <= variance_at_end(k, theta);
    };
    if (size < 3 || fits(size, Hump(size, closure).greatest_theta())) return size;
    Index lo = 2;  // fits always
    Index hi = size;
    while (hi - lo > 1) {
        const Index middle = lo + (hi - lo) / 2;
        (fits(middle, 2 * pi / static_cast<double>(middle + 1)) ? lo : hi) = middle;
    }
    return lo;
}

VectorXd in_the_middle(const VectorXd& part, Index size) {
    VectorXd whole = VectorXd::Zero(size);
    whole.segment((size - part.size()) / 2, part.size()) = part;
    return whole;
}

VectorXd nearest_in_cone(const SimplexLevel& level, const VectorXd& target) {
    Index greatest = 0;
    target.maxCoeff(&greatest);
    const VectorXd toward =
        target[greatest] > 0 ? VectorXd(target.cwiseMax(0.0)) : VectorXd(VectorXd::Unit(level.size, greatest));
    return std::sqrt(level.square) * toward.normalized();
}

}  // namespace

VectorXd smoothest_point(const SimplexLevel& level, double closure) {
    if (level.sum == 0) return std::sqrt(level.square) * Hump(level.size, closure).least_eigenvector().normalized();
    const double square = level.square / (level.sum * level.sum);
    const Index covered = hump_size(level.size, closure, square);
    return level.sum * in_the_middle(hump(covered, covered == level.size ? closure : 0.0, square), level.size);
}

VectorXd nearest_point(const SimplexLevel& level, const VectorXd& target) {
    if (level.sum == 0) return nearest_in_cone(level, target);
    const double square = level.square / (level.sum * level.sum);
    std::vector<Index> order(static_cast<std::size_t>(level.size));
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return target[a] > target[b]; });
    const double rounding = 1e-14 * target.cwiseAbs().maxCoeff() * std::sqrt(static_cast<double>(level.size));
    for (Index k = level.size; k > 1; --k) {
        const std::vector<Index> chosen(order.begin(), order.begin() + k);
        const double mean = 1.0 / static_cast<double>(k);
        const double variance = std::max(square - mean, 0.0);
        VectorXd direction = target(chosen).array() - target(chosen).mean();
        // Where the target does not choose, any point of these variables is as good: toward one of them.
        if (direction.norm() <= rounding) direction = (VectorXd::Unit(k, 0).array() - mean).matrix();
        const VectorXd x = (std::sqrt(variance) * direction.normalized().array() + mean).matrix();
        if (x.minCoeff() < 0) continue;
        VectorXd point = VectorXd::Zero(level.size);
        point(chosen) = level.sum * x;
        return point;
    }
    return level.sum * VectorXd::Unit(level.size, order.front());
}

VectorXd least_peak_point(const SimplexLevel& level) {
    const double n = static_cast<double>(level.size);
    if (level.sum == 0) return VectorXd::Constant(level.size, std::sqrt(level.square / n));
    const double square = level.square / (level.sum * level.sum);
    // k entries t and one 1 - k t: k t^2 + (1 - k t)^2 = square in [1/(k + 1), 1/k].
    const double whole = std::round(1.0 / square);
    // As many equal entries as that and no rest, but for rounding, whose root would show.
    if (std::abs(whole * square - 1) <= 1e-14 && whole >= 1 && whole <= n) {
        return level.sum * in_the_middle(VectorXd::Constant(static_cast<Index>(whole), 1.0 / whole), level.size);
    }
    const double k = std::clamp(std::floor(1.0 / square), 1.0, n);
    if (k == n) return VectorXd::Constant(level.size, level.sum / n);
    const double t = (k + std::sqrt(std::max(k * ((k + 1) * square - 1), 0.0))) / (k * (k + 1));
    VectorXd part = VectorXd::Constant(static_cast<Index>(k) + 1, t);
    part[part.size() - 1] = std::max(1 - k * t, 0.0);
    return level.sum * in_the_middle(part, level.size);
}

double shock_closure(const Kernel& kernel, const Reduction& reduction) {
    if (reduction.variables() != kernel.classes) return 0;
    const int period = kernel.pattern.period_steps();
    // Over the rounds, of the product of the last wave of one and the first of the next; all classes flip alike.
    int sum = 0;
    for (int n = kernel.classes - 1; n < period; n += kernel.classes) {
        sum += kernel.sign[static_cast<std::size_t>(n)] * kernel.sign[static_cast<std::size_t>((n + 1) % period)];
    }
    const int rounds = period / kernel.classes;
    return static_cast<double>(sum) / rounds;
}

VectorXd nearest_beta(const Kernel& kernel, const VectorXd& window) {
    VectorXd sums = VectorXd::Zero(kernel.dimension());
    for (int n = 0; n < window.size(); ++n) {
        const int step = n % kernel.pattern.period_steps();
        if (const int column = kernel.column(step); column >= 0)
            sums[column] += kernel.sign[static_cast<std::size_t>(step)] * window[n];
    }
    return sums * kernel.classes / static_cast<double>(window.size());
}

VectorXd simplex_optimum(const Kernel& kernel, const AdmissibleSet& set, Objective objective, double energy,
                         const VectorXd& reference) {
    const Reduction& reduction = set.reduction;
    const SimplexLevel level{reduction.variables(), reduction.gap_sign == 0 ? 0.0 : set.least.sum(),
                             energy / reduction.energy_factor};
    if (objective == Objective::least_force) return least_peak_point(level);
    if (objective == Objective::least_shock) return smoothest_point(level, shock_closure(kernel, reduction));
    return nearest_point(level, reduction.gamma(nearest_beta(kernel, reference)));
}

}  // namespace nsma
