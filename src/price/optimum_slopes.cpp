#include <algorithm>
#include <cmath>

#include "optimum_analysis.hpp"
#include "numerics/decompositions.hpp"

// Derivative of the optimal value to one side: the support function of the multipliers,
//   V'(delta) = max { -(y . a + w . b): (y, w) multipliers },  a, b rates of the right-hand sides,
// which is the linear program min { gradient . d } over the linearised constraints read through
// its dual. Source: J. F. Bonnans, A. Shapiro, SIAM Review 40 (1998) 228-264, section 4.

namespace nsma {
namespace {

using Greatest = MultiplierSet::Greatest::Status;

Side refused(std::string reason) { return {Side::Status::refused, 0, std::move(reason)}; }
Side nowhere() { return {Side::Status::infeasible, 0, "no orbit on this side"}; }

Eigen::VectorXd joined(const Eigen::VectorXd& head, const Eigen::VectorXd& tail) {
    Eigen::VectorXd result(head.size() + tail.size());
    result << head, tail;
    return result;
}

}  // namespace

OptimumAnalysis::Rates OptimumAnalysis::rates(const Shift& direction) const {
    Rates result;
    const double contact = form_.contact_norm > 0 ? 1.0 / (form_.contact_norm * form_.scale) : 0.0;
    result.equality = Eigen::VectorXd::Constant(equalities_.rows(), (direction.gap + direction.contact) * contact);
    result.band = equalities_.rows() > 0 ? direction.band * contact : 0.0;
    result.rows = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(active_.size()));
    for (std::size_t k = 0; k < active_.size(); ++k) {
        const auto i = active_[k];
        if (i >= set_.rows.rows()) continue;  // a row of the peak force: no right-hand side
        double rate = direction.rows.size() > 0 ? direction.rows[i] : 0.0;
        if (set_.condition[static_cast<std::size_t>(i)].condition == ConditionRow::Condition::cond1)
            rate += direction.gap;
        result.rows[static_cast<Eigen::Index>(k)] = rate / (form_.row_norm[i] * form_.scale);
    }
    result.sphere = has_sphere() ? 0.5 * direction.level / level_ : 0.0;
    return result;
}

MultiplierSet::Greatest OptimumAnalysis::greatest(const MultiplierSet& set, const Rates& rate, bool with_sphere) const {
    const Eigen::VectorXd sphere = Eigen::VectorXd::Constant(with_sphere ? 1 : 0, rate.sphere);
    if (rate.band == 0) return set.greatest(rate.rows, joined(rate.equality, sphere));
    const Eigen::VectorXd wider = rate.band + rate.equality.array();
    const Eigen::VectorXd narrower = rate.band - rate.equality.array();
    return set.greatest(joined(rate.rows, joined(wider, narrower)), sphere);
}

Side OptimumAnalysis::side(const Shift& direction) const {
    if (!refusal_.empty()) return refused(refusal_);
    const Rates rate = rates(direction);
    if (rate.rows.isZero(0) && rate.equality.isZero(0) && rate.sphere == 0 && rate.band == 0)
        return {Side::Status::finite, 0, {}};
    Side result = at_end() ? end_side(rate) : linear_side(rate);
    result.value *= form_.objective_unit;
    return result;
}

Side OptimumAnalysis::linear_side(const Rates& rate) const {
    const auto found = rate.band > 0 ? greatest(multipliers(gradient_, has_sphere(), true), rate, has_sphere())
                                     : greatest(*multipliers_, rate, has_sphere());
    switch (found.status) {
        case Greatest::finite: return {Side::Status::finite, found.value, {}};
        case Greatest::infinite: return nowhere();
        default: return refused("the multipliers are neither clearly bounded nor unbounded");
    }
}

// The level is an end of the energies near this orbit: how that end moves decides first.
Side OptimumAnalysis::end_side(const Rates& rate) const {
    const double size = rate.rows.cwiseAbs().sum() + rate.equality.cwiseAbs().sum() + std::abs(rate.sphere) + rate.band;
    double room = no_bound;  // between the level and the nearer end, per unit of the step
    double above_least = no_bound;
    for (const double sign : {1.0, -1.0}) {
        const MultiplierSet energies = multipliers(sign * sphere_, false, rate.band > 0);
        if (energies.status() == MultiplierSet::Status::empty) continue;  // no end this way
        const auto end = greatest(energies, rate, false);
        if (end.status == Greatest::infinite) return nowhere();
        if (end.status == Greatest::unclear) return refused("the end of the energy interval is unclear");
        const double distance = sign * rate.sphere - end.value;
        if (sign > 0) above_least = distance;
        // The tangent cone of a flat orbit set holds orbits of greater energy, by second order.
        if (sign > 0 || place_ == Place::corner) room = std::min(room, distance);
    }
    if (room <= -magnitude_.positive * size) return nowhere();
    if (room < magnitude_.positive * size) return refused("the end of the energy interval moves with the level");
    if (place_ == Place::flat) return refused("an end of the energy interval where second order decides");
    if (place_ == Place::corner) return linear_side(rate);
    // |d|^2 = 2 (rate of the level - rate of the least energy) t within the tangent cone.
    return {Side::Status::root, -descent_ * std::sqrt(2.0 * above_least), {}};
}

// Least-norm step that the constraints ask for, then the Newton correction within their flat.
OrbitSlope OptimumAnalysis::orbit_slope(const Shift& direction) const {
    const auto refuse = [](const std::string& reason) { return OrbitSlope{std::nullopt, reason}; };
    if (!refusal_.empty()) return refuse(refusal_);
    if (direction.band != 0) return refuse("a band opens to one side only");
    if (at_end()) return refuse("the level is an end of the energy interval");
    if (!strict_) return refuse("strict complementarity fails: an active row has no clearly positive multiplier");
    if (!isolated_) return refuse("the optimum is not isolated");
    const Rates rate = rates(direction);
    const Eigen::VectorXd sphere = Eigen::VectorXd::Constant(has_sphere() ? 1 : 0, rate.sphere);
    const Eigen::VectorXd target = joined(joined(rate.equality, rate.rows), sphere);
    Eigen::MatrixXd rows(target.size(), x_.size());
    rows << equalities_, normals_, Eigen::MatrixXd(sphere_.transpose()).topRows(sphere.size());
    Eigen::VectorXd step = Eigen::VectorXd::Zero(x_.size());
    if (rows.rows() > 0) {
        step = MinimumNorm(rows, magnitude_.positive).refined(target);
        if ((rows * step - target).norm() > magnitude_.zero * (1.0 + target.norm())) {
            return refuse("the active rows part: they are dependent and relaxed apart");
        }
    }
    bool clear = true;
    const Eigen::MatrixXd flat = orthogonal_space(rows, x_.size(), magnitude_, clear);
    if (flat.cols() > 0) {
        const Eigen::MatrixXd hessian = lagrangian();
        const auto back = solve_definite(flat.transpose() * hessian * flat, flat.transpose() * (hessian * step));
        if (!back) return refuse("the optimum is not isolated");
        step -= flat * *back;
    }
    return {form_.scale * step.head(form_.orbit_variables), {}};
}

std::optional<double> OptimumAnalysis::euler_defect() const {
    if (!multipliers_ || objective_ == Objective::nearest) return std::nullopt;
    const double degree = objective_ == Objective::least_force ? 1.0 : 2.0;
    Shift ray;
    ray.gap = set_.gap_sign;
    ray.level = 2.0 * level_;
    const Rates rate = rates(ray);
    const Eigen::VectorXd smooth = multipliers_->smooth();
    const auto contact = rate.equality.size();
    double slope = multipliers_->normal().dot(rate.rows) + smooth.head(contact).dot(rate.equality);
    if (has_sphere()) slope += smooth[contact] * rate.sphere;
    // An objective of zero (no force at all) has no relative error.
    const double size = value() != 0 ? std::abs(degree * value()) : form_.objective_unit;
    return std::abs(slope * form_.objective_unit + degree * value()) / size;
}

}  // namespace nsma
