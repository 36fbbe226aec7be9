#include "level_points.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace nsma {
namespace {

// t >= 0 with |from + t direction|^2 = square, from inside the ball. Citardauq form: no
// cancellation when `from` is close to the sphere.
double crossing(const Eigen::VectorXd& from, const Eigen::VectorXd& direction, double square) {
    const double a = direction.squaredNorm();
    const double b = from.dot(direction);
    const double c = from.squaredNorm() - square;  // <= 0
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    return b > 0 ? -c / (b + root) : (root - b) / a;
}

}  // namespace

LevelPoints::LevelPoints(const AdmissibleSet& set, double level) : set_(set), level_(level) {
    if (set.status != AdmissibleSet::Status::nonempty || set.vertices.empty() || !(level > 0)) {
        throw std::invalid_argument("set, level: expected a nonempty set with vertices and a level > 0");
    }
    base_ =
        set.reduction.gap_sign == 0 ? Eigen::VectorXd(Eigen::VectorXd::Zero(set.vertices.front().size())) : set.least;
    centre_ = base_;
    for (const auto& vertex : set.vertices) centre_ += vertex;
    // A closed gap has a cone: any positive multiple is as good.
    centre_ /= static_cast<double>(set.vertices.size() + 1);
}

std::optional<Eigen::VectorXd> LevelPoints::reach(const Eigen::VectorXd& gamma) const {
    const double square = level_ / set_.reduction.energy_factor;
    const double here = gamma.squaredNorm();
    if (set_.reduction.gap_sign == 0)
        return std::sqrt(square) * (here > 0 ? Eigen::VectorXd(gamma.normalized()) : set_.ray);
    if (here > square) {
        // Backward from the base, which lies below the level.
        const Eigen::VectorXd direction = gamma - base_;
        if (base_.squaredNorm() > square) return std::nullopt;
        return base_ + std::min(crossing(base_, direction, square), 1.0) * direction;
    }
    const Eigen::VectorXd& top = set_.vertices.front();
    if (top.squaredNorm() < square) return std::nullopt;
    const Eigen::VectorXd direction = top - gamma;
    if (direction.squaredNorm() == 0) return gamma;
    return gamma + std::min(crossing(gamma, direction, square), 1.0) * direction;
}

Eigen::VectorXd LevelPoints::mixture(int seed) const {
    std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
    // Exponential weights are uniform over mixtures; drawn from raw bits so that every
    // standard library gives the same ones.
    const auto weight = [&] {
        const double uniform = (static_cast<double>(generator() >> 11) + 0.5) * 0x1.0p-53;
        return -std::log(uniform);
    };
    double total = weight();
    Eigen::VectorXd sum = total * base_;
    for (const auto& vertex : set_.vertices) {
        const double w = weight();
        sum += w * vertex;
        total += w;
    }
    return sum / total;
}

int LevelPoints::pieces() const {
    if (set_.reduction.gap_sign == 0) return static_cast<int>(set_.vertices.size());
    return static_cast<int>(std::count_if(set_.vertices.begin(), set_.vertices.end(),
                                          [this](const auto& vertex) { return set_.energy(vertex) > level_; }));
}

std::optional<Eigen::VectorXd> LevelPoints::start(int k) const {
    // Vertices come with the greatest energy first.
    if (k > 0 && k < pieces()) return reach(set_.vertices[static_cast<std::size_t>(k)]);
    return reach(k == 0 ? base_ : mixture(k));
}

}  // namespace nsma
