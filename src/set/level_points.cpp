#include "level_points.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace nsma {
namespace {

// Distance beyond a row, relative to the size of the point, that rounding explains.
constexpr double row_rounding = 1e-13;

}  // namespace

Eigen::VectorXd crossing(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double square) {
    const Eigen::VectorXd direction = to - from;
    const double a = direction.squaredNorm();
    const double b = from.dot(direction);
    const double c = std::min(from.squaredNorm() - square, 0.0);
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    const double t = b > 0 ? -c / (b + root) : (root - b) / a;
    return from + std::min(t, 1.0) * direction;
}

double random_weight(std::mt19937_64& generator) {
    return -std::log((static_cast<double>(generator() >> 11) + 0.5) * 0x1.0p-53);
}

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
    if (set_.reduction.gap_sign == 0) return std::sqrt(square) * (here > 0 ? gamma.normalized() : set_.ray);
    if (here > square) {
        if (base_.squaredNorm() > square) return std::nullopt;
        return crossing(base_, gamma, square);
    }
    const Eigen::VectorXd& top = set_.vertices.front();
    if (top.squaredNorm() < square) return std::nullopt;
    return top == gamma ? gamma : crossing(gamma, top, square);
}

Eigen::VectorXd LevelPoints::admissible_near(Eigen::VectorXd gamma) const {
    const Reduction& data = set_.reduction;
    if (data.bounded) gamma = gamma.cwiseMax(0.0);
    const Eigen::VectorXd w = data.contact_row.cast<double>();
    if (w.squaredNorm() > 0) gamma += w * ((data.gap_sign - w.dot(gamma)) / w.squaredNorm());
    double blend = 0;
    const auto need = [&](double excess, double centre_slack) {
        if (excess <= 0) return;
        blend = std::max(blend, centre_slack > 0 ? excess / (excess + centre_slack) : 1.0);
    };
    const Eigen::MatrixXd rows = data.rows.cast<double>();
    const Eigen::VectorXd values = rows * gamma;
    const Eigen::VectorXd slacks = -(rows * centre_);
    const double rounding = row_rounding * gamma.lpNorm<1>();
    for (Eigen::Index i = 0; i < values.size(); ++i) need(values[i] - rounding, slacks[i]);
    for (Eigen::Index j = 0; data.bounded && j < gamma.size(); ++j) need(-gamma[j], centre_[j]);
    if (blend > 0) gamma += std::min(blend, 1.0) * (centre_ - gamma);
    return gamma;
}

Eigen::VectorXd LevelPoints::mixture(int seed) const {
    std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
    double total = random_weight(generator);
    Eigen::VectorXd sum = total * base_;
    for (const auto& vertex : set_.vertices) {
        const double w = random_weight(generator);
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
