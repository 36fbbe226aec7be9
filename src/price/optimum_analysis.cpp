#include "optimum_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "relaxed_solver.hpp"
#include "numerics/decompositions.hpp"
#include "numerics/polish.hpp"

namespace nsma {
namespace {

// A level this close to the least energy, relative, is the least energy: a few roundings.
constexpr double end_tolerance = 1e-12;

// -gradient on T = { d: normals d <= 0, smooth d = 0 } by its length over |gradient|.
Magnitude descends(const Eigen::MatrixXd& normals, const Eigen::MatrixXd& smooth, const Eigen::VectorXd& gradient,
                   const MagnitudeBounds& magnitude) {
    return magnitude(MultiplierSet(normals, smooth, gradient, magnitude).projection().norm() / gradient.norm());
}

Eigen::MatrixXd stacked(const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
    Eigen::MatrixXd result(top.rows() + bottom.rows(), top.cols());
    result << top, bottom;
    return result;
}

}  // namespace

OptimumAnalysis::OptimumAnalysis(const RelaxedSet& relaxed, Objective asked, std::optional<double> wanted,
                                 const Eigen::VectorXd& start, const MagnitudeBounds& magnitude,
                                 const Eigen::VectorXd& reference)
    : set(relaxed), objective(asked), magnitude_(magnitude) {
    const bool extreme = is_extreme(objective);
    if (extreme == wanted.has_value()) {
        throw std::invalid_argument(std::string("level: expected ") + (extreme ? "none" : "one") + " for objective " +
                                    std::string(name(objective)));
    }
    if (start.size() != set.dimension()) {
        throw std::invalid_argument("beta: expected size " + std::to_string(set.dimension()) + ", got " +
                                    std::to_string(start.size()));
    }
    level = wanted.value_or(set.energy(start));
    form = relaxed_program(set, objective, level, {}, reference);
    has_sphere_ = form.program.sphere_variables > 0;
    equalities_ = Eigen::MatrixXd(form.program.equalities);
    x = form.point(start);
    bool feasible = true;
    if (!settle()) {
        const Polished polished = polish(form.program, x);
        x = polished.x;
        feasible = polished.feasible;
    }
    set_point(x);
    find_active();
    if (!feasible) {
        refusal = "the point is not admissible to rounding";
        return;
    }
    find_place();
    find_multipliers();
}

void OptimumAnalysis::set_point(const Eigen::VectorXd& point) {
    x = point;
    beta = form.beta(x);
    value = form.program.objective(x) * form.objective_unit;
    gradient_ = form.program.objective_gradient(x);
    gradient_scale_ = 1.0 + gradient_.norm();
    sphere_ = Eigen::VectorXd::Zero(x.size());
    if (has_sphere_) sphere_.head(form.orbit_variables) = x.head(form.orbit_variables);
}

// Ends of the energy interval are points of their own: rounding of the level must not move them
// along the sphere, by its square root.
bool OptimumAnalysis::settle() {
    if (!has_sphere_) return false;
    const RelaxedInterval interval = relaxed_interval(set, {}, false);
    if (!interval.failed && !interval.empty && std::abs(level - interval.least) <= end_tolerance * level) {
        x = form.point(interval.least_point);
        return true;
    }
    if (form.program.violation(x) > magnitude_.zero) return false;
    find_active();
    bool clear = true;
    const bool vertex = orthogonal_space(stacked(equalities_, normals_), x.size(), magnitude_, clear).cols() == 0;
    return vertex && clear && refusal.empty();
}

void OptimumAnalysis::find_active() {
    refusal.clear();
    active.clear();
    const Eigen::VectorXd slack = form.program.inequality_values - form.program.inequalities * x;
    for (Eigen::Index i = 0; i < slack.size(); ++i) {
        switch (magnitude_(slack[i])) {
            case Magnitude::zero: active.push_back(i); break;
            case Magnitude::unclear: refusal = "a row is neither clearly active nor clearly inactive"; break;
            case Magnitude::positive: break;
        }
    }
    normals_.resize(static_cast<Eigen::Index>(active.size()), x.size());
    for (std::size_t k = 0; k < active.size(); ++k) {
        normals_.row(static_cast<Eigen::Index>(k)) = Eigen::RowVectorXd(form.program.inequalities.row(active[k]));
    }
}

void OptimumAnalysis::find_place() {
    if (!has_sphere_) return;
    const Magnitude falls = descends(normals_, equalities_, sphere_, magnitude_);
    const Magnitude grows = descends(normals_, equalities_, -sphere_, magnitude_);
    if (falls == Magnitude::unclear || grows == Magnitude::unclear) {
        refusal = "the energy level is nearly tangent to the active rows";
        return;
    }
    if (falls == Magnitude::positive && grows == Magnitude::positive) {
        place_ = Place::inside;
        return;
    }
    const Eigen::MatrixXd smooth = stacked(equalities_, sphere_.transpose());
    descent_ = MultiplierSet(normals_, smooth, gradient_, magnitude_).projection().norm();
    const Magnitude descent = magnitude_(descent_ / gradient_scale_);
    if (descent == Magnitude::unclear) {
        refusal = "the objective is neither clearly stationary at the end of the energy interval nor falling";
    } else if (descent == Magnitude::positive) {
        // At a greatest energy the objective cannot fall along the level: the level has one point.
        place_ = falls == Magnitude::zero ? Place::root : Place::flat;
    } else {
        place_ = Place::corner;
        for (Eigen::Index j = 0; j < x.size() && place_ == Place::corner; ++j) {
            for (const double way : {1.0, -1.0}) {
                if (descends(normals_, smooth, way * Eigen::VectorXd::Unit(x.size(), j), magnitude_) !=
                    Magnitude::zero) {
                    place_ = Place::flat;
                }
            }
        }
    }
}

MultiplierSet OptimumAnalysis::multipliers(bool banded) const {
    const Eigen::MatrixXd level_row = has_sphere_ ? Eigen::MatrixXd(sphere_.transpose()) : Eigen::MatrixXd(0, x.size());
    if (!banded) return {normals_, stacked(equalities_, level_row), gradient_, magnitude_};
    return {stacked(normals_, stacked(equalities_, -equalities_)), level_row, gradient_, magnitude_};
}

MultiplierSet OptimumAnalysis::energy_multipliers(double sign, bool banded) const {
    if (!banded) return {normals_, equalities_, sign * sphere_, magnitude_};
    return {stacked(normals_, stacked(equalities_, -equalities_)), Eigen::MatrixXd(0, x.size()), sign * sphere_,
            magnitude_};
}

void OptimumAnalysis::find_multipliers() {
    if (place_ == Place::root) return;
    MultiplierSet multiplier_set = multipliers(false);
    if (multiplier_set.status() == MultiplierSet::Status::unclear && place_ == Place::inside) {
        mu_ = multiplier_set.smooth()[equalities_.rows()];
        newton_step();
        multiplier_set = multipliers(false);
    }
    const auto status = multiplier_set.status();
    if (status == MultiplierSet::Status::empty || status == MultiplierSet::Status::unclear) {
        if (refusal.empty()) {
            refusal = status == MultiplierSet::Status::empty ? "the point is not stationary"
                                                             : "the multipliers are neither clearly there nor not";
        }
        return;
    }
    y_ = multiplier_set.normal();
    const Eigen::VectorXd smooth = multiplier_set.smooth();
    nu_ = smooth.head(equalities_.rows());
    mu_ = has_sphere_ ? smooth[equalities_.rows()] : 0.0;
    kkt_residual = multiplier_set.residual();
    unique = status == MultiplierSet::Status::one && (place_ == Place::free || place_ == Place::inside);
    if (!refusal.empty() || (place_ != Place::free && place_ != Place::inside)) return;

    const Eigen::VectorXd greatest = multiplier_set.greatest_normals();
    std::vector<Eigen::Index> held;
    for (Eigen::Index i = 0; i < greatest.size(); ++i) {
        if (magnitude_(greatest[i] / gradient_scale_) == Magnitude::positive) held.push_back(i);
    }
    strict = held.size() == active.size();
    if (!second_order(held)) refusal = "the optimum is not isolated: orbits of the same objective may lie beside it";
}

// Onto the active rows, then one Newton step along the directions that clearly curve. A flat
// direction, or a row of next to no multiplier, stops polish() where the objective no longer shows
// its progress, some 1e-8 away.
void OptimumAnalysis::newton_step() {
    const Eigen::MatrixXd rows = stacked(stacked(equalities_, normals_), sphere_.transpose());
    Eigen::VectorXd defect(rows.rows());
    const auto contact = equalities_.rows();
    defect.head(contact) = form.program.equality_values - equalities_ * x;
    defect.segment(contact, normals_.rows()) = form.program.inequality_values(active) - normals_ * x;
    defect[defect.size() - 1] = -0.5 * form.program.sphere_residual(x);
    const Eigen::VectorXd cleaned = x + MinimumNorm(rows).solve(defect);
    if (form.program.violation(cleaned) <= magnitude_.zero) set_point(cleaned);
    std::vector<Eigen::Index> all(active.size());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    const Eigen::MatrixXd flat = held_flat(all, true);
    if (flat.cols() == 0) return;
    const auto [curvatures, modes] = spectrum(flat.transpose() * lagrangian() * flat);
    const Eigen::VectorXd slope = modes.transpose() * (flat.transpose() * gradient_);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(slope.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
        if (curvatures[i] > magnitude_.positive * gradient_scale_) step[i] = -slope[i] / curvatures[i];
    }
    const Eigen::VectorXd moved = x + flat * (modes * step);
    if (form.program.violation(moved) > magnitude_.zero) return;
    set_point(moved);
}

// Directions that keep the held rows, COND2 and, if asked, the energy.
Eigen::MatrixXd OptimumAnalysis::held_flat(const std::vector<Eigen::Index>& held, bool with_sphere) const {
    Eigen::MatrixXd rows = stacked(equalities_, normals_(held, Eigen::all));
    if (with_sphere) rows = stacked(rows, sphere_.transpose());
    bool clear = true;
    return orthogonal_space(rows, x.size(), magnitude_, clear);
}

Eigen::MatrixXd OptimumAnalysis::lagrangian() const {
    Eigen::MatrixXd hessian(form.program.hessian);
    hessian.diagonal().head(form.orbit_variables).array() += mu_;
    return hessian;
}

// Whether the value has the slope that the multipliers give. The critical cone lies in the flat
// of the rows that some multiplier holds.
bool OptimumAnalysis::second_order(const std::vector<Eigen::Index>& held) {
    const Eigen::MatrixXd flat = held_flat(held, has_sphere_);
    isolated = flat.cols() == 0 || objective == Objective::min_energy;
    if (isolated || objective == Objective::max_energy) return isolated;
    // On a flat across the sphere the sphere's multiplier is the same for all.
    const Eigen::MatrixXd across = held_flat(held, false);
    if (magnitude_((across.transpose() * sphere_).norm()) != Magnitude::positive) return false;
    const auto least_curvature = [this](const Eigen::MatrixXd& basis) {
        return eigenvalues(basis.transpose() * lagrangian() * basis)[0] / gradient_scale_;
    };
    isolated = magnitude_(least_curvature(flat)) == Magnitude::positive;
    // A Lagrangian convex along COND2 bounds the shifted values from below, whatever the flat.
    return isolated || least_curvature(held_flat({}, false)) >= -magnitude_.zero;
}

Rates OptimumAnalysis::rates(const Shift& direction) const {
    Rates result;
    const double contact = form.contact_norm > 0 ? 1.0 / (form.contact_norm * form.scale) : 0.0;
    result.equality = Eigen::VectorXd::Constant(equalities_.rows(), (direction.gap + direction.contact) * contact);
    result.band = equalities_.rows() > 0 ? direction.band * contact : 0.0;
    result.rows = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(active.size()));
    for (std::size_t k = 0; k < active.size(); ++k) {
        const auto i = active[k];
        if (i >= set.rows.rows()) continue;  // a row of the peak force: no right-hand side
        double rate = direction.rows.size() > 0 ? direction.rows[i] : 0.0;
        if (set.condition[static_cast<std::size_t>(i)].condition == ConditionRow::Condition::cond1)
            rate += direction.gap;
        result.rows[static_cast<Eigen::Index>(k)] = rate / (form.row_norm[i] * form.scale);
    }
    result.sphere = has_sphere_ ? 0.5 * direction.level / level : 0.0;
    return result;
}

std::optional<double> OptimumAnalysis::euler_defect() const {
    if (!kkt_residual || objective == Objective::nearest) return std::nullopt;
    const double degree = objective == Objective::least_force ? 1.0 : 2.0;
    Shift ray;
    ray.gap = set.gap_sign;
    if (has_sphere_) ray.level = 2.0 * level;
    const Rates rate = rates(ray);
    const double slope = -(y_.dot(rate.rows) + nu_.dot(rate.equality) + mu_ * rate.sphere) * form.objective_unit;
    // An objective of zero (no force at all) has no relative error.
    const double size = value != 0 ? std::abs(degree * value) : form.objective_unit;
    return std::abs(slope - degree * value) / size;
}

}  // namespace nsma
