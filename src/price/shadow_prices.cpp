#include "nsma/price/shadow_prices.hpp"

#include <algorithm>
#include <cmath>

#include "optimum_analysis.hpp"
#include "relaxed_solver.hpp"
#include "tied_optima.hpp"

namespace nsma {
namespace {

// The two sides of a derivative that agree to this are one number; multipliers carry 1e-9.
constexpr double side_tolerance = 1e-8;
// Tied optima share their objective to the rounding of two polishes.
constexpr double tie_tolerance = 1e-9;

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
    // + 0.0: no negative zeros in tables
    if (right.status == Side::Status::finite) slope.right = right.value + 0.0;
    if (right.status == Side::Status::root) slope.right_root = right.value;
    if (left.status == Side::Status::finite) slope.left = 0.0 - left.value;
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
                                       const Eigen::VectorXd& beta, const Options& options,
                                       const Eigen::VectorXd& reference, const std::vector<Eigen::VectorXd>& ties) {
    const MagnitudeBounds magnitude{options.active, options.inactive};
    const auto add = [&](const Eigen::VectorXd& point) {
        branches_.push_back(std::make_unique<OptimumAnalysis>(set, objective, level, point, magnitude, reference));
    };
    const auto known = [&](const Eigen::VectorXd& point) {
        return std::any_of(branches_.begin(), branches_.end(), [&](const auto& branch) {
            return (branch->beta - point).norm() <= options.inactive * point.norm();
        });
    };
    add(beta);
    std::vector<Eigen::VectorXd> others = ties;
    // The least energy is convex and has one point; of the greatest all vertices are given.
    if (!is_extreme(objective)) {
        for (const auto& one : {std::vector{branches_.front()->beta}, ties}) {
            for (const auto& point : one) {
                TiedOptima tied = tied_optima(set, objective, point, reference);
                if (!tied.refusal.empty()) too_many_ = tied.refusal;
                others.insert(others.end(), tied.others.begin(), tied.others.end());
            }
        }
    }
    const double value = branches_.front()->value;
    for (const auto& other : others) {
        if (known(other)) continue;
        add(other);
        // A copy that its own polish left for a better or a worse orbit is none.
        const double off = std::abs(branches_.back()->value - value);
        if (branches_.back()->refusal.empty() &&
            off > tie_tolerance * (std::abs(value) + branches_.back()->form.objective_unit))
            branches_.pop_back();
    }
}

OptimumSensitivity::~OptimumSensitivity() = default;
OptimumSensitivity::OptimumSensitivity(OptimumSensitivity&&) noexcept = default;
OptimumSensitivity& OptimumSensitivity::operator=(OptimumSensitivity&&) noexcept = default;

const std::string& OptimumSensitivity::refusal() const {
    return branches_.front()->refusal.empty() ? too_many_ : branches_.front()->refusal;
}
double OptimumSensitivity::value() const { return branches_.front()->value; }
const Eigen::VectorXd& OptimumSensitivity::beta() const { return branches_.front()->beta; }
int OptimumSensitivity::tied() const { return too_many_.empty() ? static_cast<int>(branches_.size()) : 0; }
std::optional<double> OptimumSensitivity::kkt_residual() const { return branches_.front()->kkt_residual; }
std::optional<double> OptimumSensitivity::euler_defect() const { return branches_.front()->euler_defect(); }

bool OptimumSensitivity::nondegenerate() const {
    const OptimumAnalysis& one = *branches_.front();
    return one.refusal.empty() && one.unique && one.strict && one.isolated;
}

std::vector<int> OptimumSensitivity::active_rows() const {
    const OptimumAnalysis& one = *branches_.front();
    std::vector<int> rows;
    for (const auto i : one.active) {
        if (i < one.set.rows.rows()) rows.push_back(static_cast<int>(i));
    }
    return rows;
}

Slope OptimumSensitivity::slope(const Shift& direction) const {
    if (!refusal().empty()) return {Slope::Kind::refused, {}, {}, {}, {}, refusal()};
    // The best branch on each side; one that is refused refuses all.
    const bool maximum = branches_.front()->objective == Objective::max_energy;
    const auto best = [&](const Shift& way) {
        const auto rank = [](const Side& side) {
            return side.status == Side::Status::root ? 0 : side.status == Side::Status::finite ? 1 : 2;
        };
        Side result = branches_.front()->side(way);
        for (std::size_t k = 1; k < branches_.size() && result.status != Side::Status::refused; ++k) {
            const Side side = branches_[k]->side(way);
            const bool better = rank(side) != rank(result) ? rank(side) < rank(result)
                                : maximum                  ? side.value > result.value
                                                           : side.value < result.value;
            if (better || side.status == Side::Status::refused) result = side;
        }
        return result;
    };
    const Side left = direction.band > 0 ? Side{Side::Status::infeasible, 0, "a band has no negative width"}
                                         : best(negated(direction));
    return from_sides(best(direction), left);
}

OrbitSlope OptimumSensitivity::orbit_slope(const Shift& direction) const {
    return branches_.front()->orbit_slope(direction);
}

}  // namespace nsma
