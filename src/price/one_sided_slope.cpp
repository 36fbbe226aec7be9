#include <algorithm>
#include <cmath>

#include "optimum_analysis.hpp"

// Derivative of the optimal value to one side: the support function of the multipliers,
//   V'(delta) = max { -(y . a + w . b): (y, w) multipliers },  a, b rates of the right-hand sides,
// which is the linear program min { gradient . d } over the linearised constraints read through
// its dual. Source: J. F. Bonnans, A. Shapiro, SIAM Review 40 (1998) 228-264, section 4.

namespace nsma {
namespace {

Side refused(const char* reason) { return {Side::Status::refused, 0, reason}; }
Side nowhere() { return {Side::Status::infeasible, 0, "no orbit on this side"}; }

// Rates of the rows with a sign and of those without, in the order of the multiplier sets. A band
// makes COND2 two rows with a sign.
struct Split {
    Eigen::VectorXd signed_rows, smooth;
};

Split split(const Rates& rate, bool banded, bool with_sphere) {
    Split result;
    const auto rows = rate.rows.size();
    const auto contact = rate.equality.size();
    result.signed_rows.resize(rows + (banded ? 2 * contact : 0));
    result.signed_rows.head(rows) = rate.rows;
    if (banded) {
        result.signed_rows.segment(rows, contact) = rate.band + rate.equality.array();
        result.signed_rows.tail(contact) = rate.band - rate.equality.array();
    }
    result.smooth.resize((banded ? 0 : contact) + (with_sphere ? 1 : 0));
    if (!banded) result.smooth.head(contact) = rate.equality;
    if (with_sphere) result.smooth[result.smooth.size() - 1] = rate.sphere;
    return result;
}

double size_of(const Rates& rate) {
    return rate.rows.cwiseAbs().sum() + rate.equality.cwiseAbs().sum() + std::abs(rate.sphere) + rate.band;
}

}  // namespace

Side OptimumAnalysis::side(const Shift& direction) const {
    if (!refusal.empty()) return refused(refusal.c_str());
    const Rates rate = rates(direction);
    if (rate.nothing()) return {Side::Status::finite, 0, {}};
    Side result = place_ == Place::free || place_ == Place::inside ? linear_side(rate) : end_side(rate);
    result.value *= form.objective_unit;
    return result;
}

Side OptimumAnalysis::linear_side(const Rates& rate) const {
    const bool banded = rate.band > 0;
    const Split parts = split(rate, banded, has_sphere_);
    const auto found = multipliers(banded).greatest(parts.signed_rows, parts.smooth);
    switch (found.status) {
        case MultiplierSet::Greatest::Status::finite: return {Side::Status::finite, found.value, {}};
        case MultiplierSet::Greatest::Status::infinite: return nowhere();
        default: return refused("the multipliers are neither clearly bounded nor unbounded");
    }
}

// The level is an end of the energies near this orbit: how that end moves decides first.
Side OptimumAnalysis::end_side(const Rates& rate) const {
    const bool banded = rate.band > 0;
    const Split parts = split(rate, banded, false);
    const double size = size_of(rate);
    double room = no_bound;  // between the level and the nearer end, per unit of the step
    double above_least = no_bound;
    for (const double sign : {1.0, -1.0}) {
        const MultiplierSet energies = energy_multipliers(sign, banded);
        if (energies.status() == MultiplierSet::Status::empty) continue;  // no end this way
        if (energies.status() == MultiplierSet::Status::unclear)
            return refused("the end of the energy interval is unclear");
        const auto end = energies.greatest(parts.signed_rows, parts.smooth);
        if (end.status == MultiplierSet::Greatest::Status::infinite) return nowhere();
        if (end.status == MultiplierSet::Greatest::Status::unclear)
            return refused("the end of the energy interval is unclear");
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

}  // namespace nsma
