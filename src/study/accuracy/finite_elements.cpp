#include "finite_elements.hpp"

#include <algorithm>
#include <cmath>

namespace nsma {
namespace {

constexpr double theta = 0.5;  // of the implicit scheme: the trapezoidal rule, which dissipates nothing in free motion

// Integral of a function that is constant on each of `values.size()` equal cells of [0, 1] over
// [from, to].
double integral(const Eigen::VectorXd& values, double from, double to) {
    const auto cells = static_cast<double>(values.size());
    double sum = 0;
    const auto first = static_cast<Eigen::Index>(std::floor(from * cells));
    for (Eigen::Index i = std::max<Eigen::Index>(first, 0); i < values.size(); ++i) {
        const double left = std::max(from, static_cast<double>(i) / cells);
        const double right = std::min(to, static_cast<double>(i + 1) / cells);
        if (left >= to) break;
        if (right > left) sum += values[i] * (right - left);
    }
    return sum;
}

}  // namespace

FiniteElementBar::FiniteElementBar(const Bar& bar, const Mesh& mesh, const State& state, double duration,
                                   const FiniteElementOptions& options)
    : options_(options), gap_(bar.gap) {
    validate(bar);
    validate(mesh, state);
    const int n = options.elements;
    const double h = bar.length / n;
    stiffness_ = bar.young_modulus * bar.area / h;
    mass_ = Eigen::VectorXd::Constant(n, bar.density * bar.area * h);
    mass_[n - 1] /= 2;
    const double longest = options.courant * h / bar.wave_speed();
    steps_ = std::max(1, static_cast<int>(std::ceil(duration / longest * (1 - 1e-12))));
    time_step_ = duration / steps_;

    displacement_.resize(n);
    velocity_.resize(n);
    const Eigen::VectorXd strain = state.head(mesh.cells) / bar.young_modulus;
    const Eigen::VectorXd speed = state.tail(mesh.cells);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double node = static_cast<double>(i + 1) / n;
        sum += bar.length * integral(strain, static_cast<double>(i) / n, node);
        displacement_[i] = sum;
        const double left = node - 0.5 / n;
        const double right = std::min(node + 0.5 / n, 1.0);
        velocity_[i] = integral(speed, left, right) / (right - left);
    }
    if (options.scheme == FiniteElementScheme::moreau_jean) {
        factorise();
    } else {
        velocity_ -= 0.5 * time_step_ * acceleration();  // to half a step before the start
    }
}

Eigen::VectorXd FiniteElementBar::elastic_force(const Eigen::VectorXd& displacement) const {
    const auto n = displacement.size();
    Eigen::VectorXd force(n);
    double left = stiffness_ * displacement[0];  // tension of the element to the left
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
        const double right = stiffness_ * (displacement[i + 1] - displacement[i]);
        force[i] = right - left;
        left = right;
    }
    force[n - 1] = -left;
    return force;
}

Eigen::VectorXd FiniteElementBar::acceleration() const {
    Eigen::VectorXd force = elastic_force(displacement_);
    force[force.size() - 1] -= options_.penalty * stiffness_ * std::max(tip() - gap_, 0.0);
    return force.cwiseQuotient(mass_);
}

void FiniteElementBar::factorise() {
    const auto n = mass_.size();
    const double factor = theta * theta * time_step_ * time_step_ * stiffness_;
    pivot_.resize(n);
    ratio_.setZero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        pivot_[i] = mass_[i] + factor * (i + 1 < n ? 2.0 : 1.0);
        if (i == 0) continue;
        ratio_[i] = -factor / pivot_[i - 1];
        pivot_[i] += factor * ratio_[i];
    }
    tip_response_.resize(n);
    tip_response_[n - 1] = 1.0 / pivot_[n - 1];
    for (Eigen::Index i = n - 2; i >= 0; --i) tip_response_[i] = factor * tip_response_[i + 1] / pivot_[i];
}

Eigen::VectorXd FiniteElementBar::solve(Eigen::VectorXd right) const {
    const auto n = right.size();
    for (Eigen::Index i = 1; i < n; ++i) right[i] -= ratio_[i] * right[i - 1];
    right[n - 1] /= pivot_[n - 1];
    for (Eigen::Index i = n - 2; i >= 0; --i) right[i] = right[i] / pivot_[i] - ratio_[i + 1] * right[i + 1];
    return right;
}

void FiniteElementBar::step() {
    const double dt = time_step_;
    if (options_.scheme == FiniteElementScheme::central_penalty) {
        velocity_ += dt * acceleration();
        displacement_ += dt * velocity_;
        contact_ = tip() > gap_;
        return;
    }
    // (M + theta^2 dt^2 K)(v+ - v) = dt f(u + theta dt v) + P e_tip,
    // with 0 <= P _|_ wall speed after the impact, where the tip is forecast to be at the wall.
    const auto last = velocity_.size() - 1;
    const double before = velocity_[last];
    Eigen::VectorXd after = velocity_ + solve(dt * elastic_force(displacement_ + theta * dt * velocity_));
    contact_ = false;
    if (tip() + 0.5 * dt * before >= gap_) {
        const double excess = after[last] + options_.restitution * before;
        if (excess > 0) {
            contact_ = true;
            after -= tip_response_ * (excess / tip_response_[last]);
        }
    }
    displacement_ += dt * (theta * after + (1 - theta) * velocity_);
    velocity_ = after;
}

Eigen::VectorXd FiniteElementBar::velocity() const {
    if (options_.scheme == FiniteElementScheme::moreau_jean) return velocity_;
    return velocity_ + 0.5 * time_step_ * acceleration();
}

double FiniteElementBar::energy_of(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity) const {
    return 0.5 * velocity.dot(mass_.cwiseProduct(velocity)) - 0.5 * displacement.dot(elastic_force(displacement));
}

double FiniteElementBar::energy() const {
    double result = energy_of(displacement_, velocity());
    if (options_.scheme == FiniteElementScheme::central_penalty) {
        const double depth = std::max(tip() - gap_, 0.0);
        result += 0.5 * options_.penalty * stiffness_ * depth * depth;
    }
    return result;
}

}  // namespace nsma
