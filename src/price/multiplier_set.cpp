#include "multiplier_set.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "numerics/decompositions.hpp"
#include "numerics/least_squares.hpp"
#include "numerics/linear_program.hpp"

namespace nsma {
namespace {

// CLP works to 1e-9; what it answers is solved again on its support and judged by its dual.
constexpr double certificate_tolerance = 1e-9;

double smallest(const Eigen::VectorXd& values) { return values.size() > 0 ? values.minCoeff() : 0.0; }

}  // namespace

Eigen::MatrixXd orthogonal_space(const Eigen::MatrixXd& rows, Eigen::Index n, const MagnitudeBounds& magnitude,
                                 bool& rank_clear) {
    rank_clear = true;
    if (rows.rows() == 0) return Eigen::MatrixXd::Identity(n, n);
    const Singular right = right_singular(rows);
    Eigen::Index rank = 0;
    for (const double singular : right.values) {
        const Magnitude size = magnitude(singular);
        if (size == Magnitude::unclear) rank_clear = false;
        if (size != Magnitude::zero) ++rank;
    }
    return right.vectors.rightCols(n - rank);
}

MultiplierSet::MultiplierSet(Eigen::MatrixXd normals, Eigen::MatrixXd smooth, Eigen::VectorXd gradient,
                             const MagnitudeBounds& magnitude)
    : normals_(std::move(normals)),
      smooth_(std::move(smooth)),
      gradient_(std::move(gradient)),
      magnitude_(magnitude),
      scale_(1.0 + gradient_.norm()) {
    bool clear = true;
    const Eigen::MatrixXd basis = orthogonal_space(smooth_, gradient_.size(), magnitude_, clear);
    Eigen::MatrixXd columns = basis.transpose() * normals_.transpose();
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
        const Magnitude size = magnitude_(columns.col(i).norm());
        if (size == Magnitude::unclear) clear = false;
        if (size == Magnitude::zero) columns.col(i).setZero();  // its rounding is no direction
    }
    const Eigen::VectorXd wanted = -(basis.transpose() * gradient_);
    const NonnegativeSolution nearest = nonnegative_least_squares(columns, wanted);
    y_ = nearest.y;
    projection_ = basis * nearest.residual;
    const Magnitude distance = magnitude_(nearest.residual.norm() / scale_);
    if (!clear || !nearest.converged || distance == Magnitude::unclear) return;
    if (distance == Magnitude::positive) {
        status_ = Status::empty;
        return;
    }
    const auto count = normals_.rows();
    if (count == 0 || columns.rows() == 0) {
        system_.resize(0, count);
        target_.resize(0);
        status_ = count == 0 ? Status::one : Status::many;
        return;
    }
    const Singular left = left_singular(columns);
    Eigen::Index rank = 0;
    for (const double singular : left.values) {
        const Magnitude size = magnitude_(singular);
        if (size == Magnitude::unclear) return;
        if (size == Magnitude::positive) ++rank;
    }
    system_ = left.vectors.leftCols(rank).transpose() * columns;
    target_ = system_ * y_;  // attained by construction, and equal to the wanted one to rounding
    if (rank < count) {
        status_ = Status::many;
        return;
    }
    // Independent normals: rounding may have left a multiplier of zero out, or below zero.
    y_ = least_squares(columns, wanted);
    status_ = smallest(y_) >= -magnitude_.zero * scale_ ? Status::one : Status::unclear;
}

Eigen::VectorXd MultiplierSet::smooth() const {
    if (smooth_.rows() == 0) return {};
    const Eigen::VectorXd balance = gradient_ + normals_.transpose() * y_;
    return MinimumNorm(smooth_.transpose(), magnitude_.positive).solve(-balance);
}

double MultiplierSet::residual() const {
    Eigen::VectorXd balance = gradient_ + normals_.transpose() * y_;
    if (smooth_.rows() > 0) balance += smooth_.transpose() * smooth();
    return balance.norm() / scale_;
}

// Least cost . y over the set, where the linear program has an answer that its dual certifies.
std::optional<Eigen::VectorXd> MultiplierSet::certified_least(const Eigen::VectorXd& cost) const {
    const auto count = cost.size();
    const LinearProgram program{system_, target_, target_, Eigen::VectorXd::Zero(count),
                                Eigen::VectorXd::Constant(count, no_bound)};
    const LinearSolution solution = LinearSolver(program).minimise(cost);
    if (solution.status != LinearStatus::optimal) return std::nullopt;
    std::vector<Eigen::Index> support;
    for (Eigen::Index i = 0; i < count; ++i) {
        if (solution.x[i] > certificate_tolerance * scale_) support.push_back(i);
    }
    Eigen::VectorXd y = Eigen::VectorXd::Zero(count);
    if (!support.empty()) y(support) = least_squares(system_(Eigen::all, support), target_);
    const Eigen::VectorXd& z = solution.row_dual;
    const double size = 1.0 + cost.norm();
    const bool primal = (system_ * y - target_).norm() <= certificate_tolerance * scale_ &&
                        smallest(y) >= -certificate_tolerance * scale_;
    const bool dual = smallest(cost - system_.transpose() * z) >= -certificate_tolerance * size;
    const bool tight = std::abs(cost.dot(y) - target_.dot(z)) <= certificate_tolerance * size * (scale_ + y.norm());
    return primal && dual && tight ? std::optional(y) : std::nullopt;
}

MultiplierSet::Greatest MultiplierSet::least_over_set(const Eigen::VectorXd& cost) const {
    using Answer = Greatest::Status;
    const auto count = cost.size();
    if (status_ == Status::one || count == 0) return {Answer::finite, cost.dot(y_), y_};
    if (const auto y = certified_least(cost)) return {Answer::finite, cost.dot(*y), *y};
    // Unbounded if and only if a ray r >= 0, system r = 0 has cost . r < 0: minus the residual of
    // cost on { system' z + s, s >= 0 } is the steepest one.
    Eigen::MatrixXd dual_cone(count, 2 * system_.rows() + count);
    dual_cone << system_.transpose(), -system_.transpose(), Eigen::MatrixXd::Identity(count, count);
    const NonnegativeSolution nearest = nonnegative_least_squares(dual_cone, cost);
    const Magnitude excess = magnitude_(nearest.residual.norm() / std::max(cost.norm(), 1e-300));
    if (excess == Magnitude::positive) return {Answer::infinite, 0, {}};
    return {};
}

MultiplierSet::Greatest MultiplierSet::greatest(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    if (status_ != Status::one && status_ != Status::many) return {};
    // w = -pinv(smooth')(gradient + normals' y), so w . b = -(gradient + normals' y) . step.
    Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient_.size());
    if (smooth_.rows() > 0) step = MinimumNorm(smooth_, magnitude_.positive).refined(b);
    Greatest result = least_over_set(a - normals_ * step);
    result.value = gradient_.dot(step) - result.value;
    return result;
}

Eigen::VectorXd MultiplierSet::greatest_normals() const {
    if (status_ == Status::one) return y_;
    Eigen::VectorXd best = y_;
    for (Eigen::Index i = 0; i < best.size(); ++i) {
        if (best[i] >= magnitude_.positive * scale_) continue;
        Eigen::VectorXd cost = Eigen::VectorXd::Zero(best.size());
        cost[i] = -1.0;
        const Greatest found = least_over_set(cost);
        switch (found.status) {
            case Greatest::Status::finite: best = best.cwiseMax(found.y); break;
            case Greatest::Status::infinite: best[i] = scale_; break;
            case Greatest::Status::unclear: best[i] = -scale_; break;
        }
    }
    return best;
}

}  // namespace nsma
