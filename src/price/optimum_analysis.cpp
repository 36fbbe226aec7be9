#include "optimum_analysis.hpp"

#include <cmath>
#include <stdexcept>

#include "numerics/decompositions.hpp"
#include "numerics/expect_size.hpp"
#include "numerics/polish.hpp"
#include "nsma/set/admissible_set.hpp"

namespace nsma {
namespace {

// A level this close to the least energy, relative, is the least energy: a few roundings.
constexpr double end_tolerance = 1e-12;

Eigen::MatrixXd stacked(const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
    Eigen::MatrixXd result(top.rows() + bottom.rows(), top.cols());
    result << top, bottom;
    return result;
}

double checked_level(const RelaxedSet& set, Objective objective, std::optional<double> level,
                     const Eigen::VectorXd& start) {
    const bool extreme = is_extreme(objective);
    if (extreme == level.has_value()) {
        throw std::invalid_argument(std::string("level: expected ") + (extreme ? "none" : "one") + " for objective " +
                                    std::string(name(objective)));
    }
    expect_size("beta", set.dimension(), start.size());
    return level.value_or(set.energy(start));
}

}  // namespace

OptimumAnalysis::OptimumAnalysis(const RelaxedSet& set, Objective objective, std::optional<double> level,
                                 const Eigen::VectorXd& start, const Eigen::VectorXd& reference)
    : set_(set),
      objective_(objective),
      level_(checked_level(set, objective, level, start)),
      form_(relaxed_program(set, objective, level_, {}, reference)),
      equalities_(form_.program.equalities) {
    set_point(form_.point(start));
    bool feasible = true;
    if (!at_fixed_point()) {
        const Polished polished = polish(form_.program, x_);
        set_point(polished.x);
        feasible = polished.feasible;
    }
    if (!feasible) {
        refusal_ = "the point is not admissible to rounding";
        return;
    }
    if (has_sphere()) find_place();
    if (place_ != Place::root) find_multipliers();
}

void OptimumAnalysis::set_point(const Eigen::VectorXd& point) {
    x_ = point;
    gradient_ = form_.program.objective_gradient(x_);
    gradient_scale_ = 1.0 + gradient_.norm();
    sphere_ = Eigen::VectorXd::Zero(x_.size());
    if (has_sphere()) sphere_.head(form_.orbit_variables) = x_.head(form_.orbit_variables);
    refusal_.clear();
    active_.clear();
    const Eigen::VectorXd slack = form_.program.inequality_values - form_.program.inequalities * x_;
    for (Eigen::Index i = 0; i < slack.size(); ++i) {
        const Magnitude size = magnitude_(slack[i]);
        if (size == Magnitude::zero) active_.push_back(i);
        if (size == Magnitude::unclear) refusal_ = "a row is neither clearly active nor clearly inactive";
    }
    normals_ = Eigen::MatrixXd(form_.program.inequalities)(active_, Eigen::all);
}

// Ends of the energy interval are points of their own: rounding of the level must not move them
// along the sphere, by its square root.
bool OptimumAnalysis::at_fixed_point() {
    if (!has_sphere()) return false;
    const AdmissibleSet known = admissible_set(reduce(conditions(set_.kernel, set_.gap_sign)));
    const std::optional<double> least = known.interval().least;
    if (least && set_.gap_sign != 0 && std::abs(level_ - *least) <= end_tolerance * level_) {
        set_point(form_.point(known.reduction.beta(known.least)));
        return true;
    }
    if (form_.program.violation(x_) > magnitude_.zero || !refusal_.empty()) return false;
    bool clear = true;
    return orthogonal_space(stacked(equalities_, normals_), x_.size(), magnitude_, clear).cols() == 0 && clear;
}

MultiplierSet OptimumAnalysis::multipliers(const Eigen::VectorXd& gradient, bool with_sphere, bool banded) const {
    Eigen::MatrixXd smooth = banded ? Eigen::MatrixXd(0, x_.size()) : equalities_;
    if (with_sphere) smooth = stacked(smooth, sphere_.transpose());
    if (!banded) return {normals_, smooth, gradient, magnitude_};
    return {stacked(normals_, stacked(equalities_, -equalities_)), smooth, gradient, magnitude_};
}

Magnitude OptimumAnalysis::descends(const Eigen::VectorXd& gradient, bool with_sphere) const {
    return magnitude_(multipliers(gradient, with_sphere).projection().norm() / gradient.norm());
}

void OptimumAnalysis::find_place() {
    const Magnitude falls = descends(sphere_, false);
    const Magnitude grows = descends(-sphere_, false);
    if (falls == Magnitude::unclear || grows == Magnitude::unclear) {
        refusal_ = "the energy level is nearly tangent to the active rows";
        return;
    }
    if (falls == Magnitude::positive && grows == Magnitude::positive) {
        place_ = Place::inside;
        return;
    }
    descent_ = multipliers(gradient_, true).projection().norm();
    const Magnitude descent = magnitude_(descent_ / gradient_scale_);
    if (descent == Magnitude::unclear) {
        refusal_ = "the objective is neither clearly stationary at the end of the energy interval nor falling";
    } else if (descent == Magnitude::positive) {
        // At a greatest energy the objective cannot fall along the level: the level has one point.
        place_ = falls == Magnitude::zero ? Place::root : Place::flat;
    } else {
        place_ = Place::corner;
        for (Eigen::Index j = 0; j < x_.size() && place_ == Place::corner; ++j) {
            for (const double way : {1.0, -1.0}) {
                if (descends(way * Eigen::VectorXd::Unit(x_.size(), j), true) != Magnitude::zero) place_ = Place::flat;
            }
        }
    }
}

void OptimumAnalysis::find_multipliers() {
    MultiplierSet found = multipliers(gradient_, has_sphere());
    using Status = MultiplierSet::Status;
    if (found.status() == Status::empty || found.status() == Status::unclear) {
        if (!refusal_.empty()) return;
        refusal_ = found.status() == Status::empty ? "the point is not stationary"
                                                   : "the multipliers are neither clearly there nor not";
        return;
    }
    multipliers_ = std::move(found);
    if (!refusal_.empty() || at_end()) return;

    const Eigen::VectorXd greatest = multipliers_->greatest_normals();
    std::vector<Eigen::Index> held;
    for (Eigen::Index i = 0; i < greatest.size(); ++i) {
        if (magnitude_(greatest[i] / gradient_scale_) == Magnitude::positive) held.push_back(i);
    }
    strict_ = held.size() == active_.size();
    if (!has_slope(held)) refusal_ = "the optimum is not isolated: orbits of the same objective may lie beside it";
}

// Directions that keep the held rows, COND2 and, if asked, the energy.
Eigen::MatrixXd OptimumAnalysis::flat(const std::vector<Eigen::Index>& held, bool with_sphere) const {
    Eigen::MatrixXd rows = stacked(equalities_, normals_(held, Eigen::all));
    if (with_sphere) rows = stacked(rows, sphere_.transpose());
    bool clear = true;
    return orthogonal_space(rows, x_.size(), magnitude_, clear);
}

Eigen::MatrixXd OptimumAnalysis::lagrangian() const {
    Eigen::MatrixXd hessian(form_.program.hessian);
    if (has_sphere()) hessian.diagonal().head(form_.orbit_variables).array() += multipliers_->smooth().tail(1)[0];
    return hessian;
}

// Whether the value has the slope that the multipliers give. The critical cone lies in the flat
// of the rows that some multiplier holds.
bool OptimumAnalysis::has_slope(const std::vector<Eigen::Index>& held) {
    const Eigen::MatrixXd kept = flat(held, has_sphere());
    isolated_ = kept.cols() == 0 || objective_ == Objective::min_energy;
    if (isolated_ || objective_ == Objective::max_energy) return isolated_;
    // On a flat across the sphere the sphere's multiplier is the same for all.
    if (magnitude_((flat(held, false).transpose() * sphere_).norm()) != Magnitude::positive) return false;
    const Eigen::MatrixXd hessian = lagrangian();
    const auto least_curvature = [&](const Eigen::MatrixXd& basis) {
        return eigenvalues(basis.transpose() * hessian * basis)[0] / gradient_scale_;
    };
    isolated_ = magnitude_(least_curvature(kept)) == Magnitude::positive;
    // A Lagrangian convex along COND2 bounds the shifted values from below, whatever the flat.
    return isolated_ || least_curvature(flat({}, false)) >= -magnitude_.zero;
}

bool OptimumAnalysis::nondegenerate() const {
    const bool unique = multipliers_ && multipliers_->status() == MultiplierSet::Status::one && !at_end();
    return refusal_.empty() && unique && strict_ && isolated_;
}

std::vector<int> OptimumAnalysis::active_rows() const {
    std::vector<int> rows;
    for (const auto i : active_) {
        if (i < set_.rows.rows()) rows.push_back(static_cast<int>(i));
    }
    return rows;
}

std::optional<double> OptimumAnalysis::kkt_residual() const {
    return multipliers_ ? std::optional(multipliers_->residual()) : std::nullopt;
}

}  // namespace nsma
