#include "nsma/price/shadow_prices.hpp"

#include <algorithm>
#include <cmath>

#include "optimum_analysis.hpp"
#include "tied_optima.hpp"

namespace nsma {
namespace {

// The two sides of a derivative that agree to this are one number; multipliers carry 1e-9.
constexpr double side_tolerance = 1e-8;
// Tied optima share their objective to the rounding of two polishes.
constexpr double tie_tolerance = 1e-9;
// Multipliers of a few units whose terms cancel leave a few roundings.
constexpr double slope_rounding = 1e-14;
// Optima closer than this, relative, are one.
constexpr double same_point = MagnitudeBounds{}.positive;

Slope from_sides(const Side& right, const Side& left) {
    Slope slope;
    const auto note = [&](const char* where, const Side& side) {
        if (side.status == Side::Status::finite) return;
        if (!slope.reason.empty()) slope.reason += "; ";
        slope.reason += where;
        slope.reason += side.status == Side::Status::root ? "infinite slope, a square root of the step" : side.reason;
    };
    note("right: ", right);
    note("left: ", left);
    if (right.status == Side::Status::refused && left.status == Side::Status::refused) {
        if (right.reason == left.reason) slope.reason = right.reason;
        return slope;
    }
    slope.kind = Slope::Kind::one_sided;
    // A side that is rounding beside the other is zero; + 0.0: no negative zeros in tables.
    const auto number = [](const Side& side, const Side& other) {
        return std::abs(side.value) > slope_rounding * std::abs(other.value) ? side.value : 0.0;
    };
    if (right.status == Side::Status::finite) slope.right = number(right, left) + 0.0;
    if (right.status == Side::Status::root) slope.right_root = right.value;
    if (left.status == Side::Status::finite) slope.left = 0.0 - number(left, right);
    if (left.status == Side::Status::root) slope.left_root = left.value;
    if (slope.right && slope.left &&
        std::abs(*slope.right - *slope.left) <=
            side_tolerance * (std::abs(*slope.right) + std::abs(*slope.left)) + 1e-12) {
        slope.kind = Slope::Kind::two_sided;
        slope.left = slope.right;
    } else if (slope.reason.empty()) {
        slope.reason = "several multipliers or several optima: the sides differ";
    }
    return slope;
}

Shift negated(const Shift& shift) {
    Shift result = shift;
    result.gap = -shift.gap;
    result.level = -shift.level;
    result.contact = -shift.contact;
    result.rows = -shift.rows;
    return result;
}

}  // namespace

OptimumSensitivity::OptimumSensitivity(const RelaxedSet& set, Objective objective, std::optional<double> level,
                                       const Eigen::VectorXd& beta, const Eigen::VectorXd& reference)
    : objective_(objective) {
    const auto analysed = [&](const Eigen::VectorXd& point) {
        return std::make_shared<const OptimumAnalysis>(set, objective, level, point, reference);
    };
    branches_.push_back(analysed(beta));
    const OptimumAnalysis& first = *branches_.front();
    TiedOptima ties;
    // The least energy is convex and has one point.
    if (objective != Objective::min_energy) ties = tied_optima(set, objective, first.beta(), reference);
    refusal_ = first.refusal().empty() ? ties.refusal : first.refusal();
    for (const auto& other : ties.others) {
        const bool known = std::any_of(branches_.begin(), branches_.end(), [&](const auto& branch) {
            return (branch->beta() - other).norm() <= same_point * other.norm();
        });
        if (known) continue;
        auto branch = analysed(other);
        // A copy that its own polish left for a better or a worse orbit is none.
        const double off = std::abs(branch->value() - first.value());
        if (!branch->refusal().empty() || off <= tie_tolerance * (std::abs(first.value()) + branch->objective_unit()))
            branches_.push_back(std::move(branch));
    }
    if (ties.refusal.empty()) tied_ = static_cast<int>(branches_.size());
}

double OptimumSensitivity::value() const { return branches_.front()->value(); }
Eigen::VectorXd OptimumSensitivity::beta() const { return branches_.front()->beta(); }
bool OptimumSensitivity::nondegenerate() const { return branches_.front()->nondegenerate(); }
std::vector<int> OptimumSensitivity::active_rows() const { return branches_.front()->active_rows(); }
std::optional<double> OptimumSensitivity::kkt_residual() const { return branches_.front()->kkt_residual(); }
std::optional<double> OptimumSensitivity::euler_defect() const { return branches_.front()->euler_defect(); }
OrbitSlope OptimumSensitivity::orbit_slope(const Shift& direction) const {
    return branches_.front()->orbit_slope(direction);
}

// The best branch on each side; one that is refused refuses all.
Slope OptimumSensitivity::slope(const Shift& direction) const {
    if (!refusal_.empty()) return {Slope::Kind::refused, {}, {}, {}, {}, refusal_};
    const auto better = [this](const Side& a, const Side& b) {
        if (a.status != b.status) return a.status < b.status;  // a root is steeper than any number
        return objective_ == Objective::max_energy ? a.value > b.value : a.value < b.value;
    };
    const auto best = [&](const Shift& way) {
        Side result = branches_.front()->side(way);
        for (std::size_t k = 1; k < branches_.size() && result.status != Side::Status::refused; ++k) {
            const Side side = branches_[k]->side(way);
            if (side.status == Side::Status::refused || better(side, result)) result = side;
        }
        return result;
    };
    const Side left = direction.band > 0 ? Side{Side::Status::infeasible, 0, "a band has no negative width"}
                                         : best(negated(direction));
    return from_sides(best(direction), left);
}

}  // namespace nsma
