#include <algorithm>
#include <cmath>

#include "nsma/orbit/backbone.hpp"
#include "price/relaxed_solver.hpp"
#include "nsma/study/sensitivity/sensitivity.hpp"

namespace nsma {
namespace {

// What has a price at an end of the energy interval.
const std::vector<Parameter> length_and_force{Parameter::gap, Parameter::contact, Parameter::band,
                                              Parameter::penetration, Parameter::adhesion};

// The direction that moves one parameter by one unit.
Shift direction_of(const RelaxedSet& set, Parameter parameter, int row = -1) {
    Shift shift;
    switch (parameter) {
        case Parameter::cond1_row:
        case Parameter::cond3_row:
            shift.rows = Eigen::VectorXd::Zero(set.rows.rows());
            shift.rows[row] = 1.0;
            break;
        case Parameter::gap: shift.gap = 1.0; break;
        case Parameter::contact: shift.contact = 1.0; break;
        case Parameter::band: shift.band = 1.0; break;
        case Parameter::penetration: shift.rows = set.shift({1.0, 0.0, 0.0}).rows; break;
        case Parameter::adhesion: shift.rows = set.shift({0.0, 0.0, 1.0}).rows; break;
        case Parameter::energy: shift.level = 1.0; break;
    }
    return shift;
}

std::vector<Price> prices_of(const RelaxedSet& set, const OptimumSensitivity& optimum,
                             const std::vector<Parameter>& parameters) {
    std::vector<Price> prices;
    prices.reserve(parameters.size());
    for (const Parameter parameter : parameters) {
        prices.push_back({parameter, {}, true, optimum.slope(direction_of(set, parameter))});
    }
    return prices;
}

}  // namespace

std::string_view name(Parameter parameter) {
    switch (parameter) {
        case Parameter::cond1_row: return "cond1";
        case Parameter::cond3_row: return "cond3";
        case Parameter::gap: return "gap";
        case Parameter::contact: return "contact";
        case Parameter::band: return "band";
        case Parameter::penetration: return "penetration";
        case Parameter::adhesion: return "adhesion";
        default: return "energy";
    }
}

double unit_of(Parameter parameter, const Bar& bar) {
    switch (parameter) {
        case Parameter::energy: return bar.energy_unit();
        case Parameter::cond3_row:
        case Parameter::adhesion: return bar.force_unit();
        default: return bar.displacement_unit();
    }
}

OptimumRecord optimum_record(const Orbit& orbit, int gap_sign, Objective objective, std::optional<double> level,
                             const Eigen::VectorXd& reference) {
    const RelaxedSet set = relaxed_set(orbit.kernel, gap_sign);
    const Objective asked = level || objective == Objective::max_energy ? objective : Objective::min_energy;
    const OptimumSensitivity optimum(set, asked, level, orbit.beta, reference);
    OptimumRecord record;
    record.orbit = orbit;
    record.objective = asked;
    record.level = level;
    record.value = optimum.value();
    record.nondegenerate = optimum.nondegenerate();
    record.tied = optimum.tied();
    record.refusal = optimum.refusal();
    record.kkt_residual = optimum.kkt_residual();
    record.euler_defect = optimum.euler_defect();
    std::vector<Parameter> whole = length_and_force;
    if (level) whole.push_back(Parameter::energy);
    record.prices = prices_of(set, optimum, whole);
    const std::vector<int> active = optimum.active_rows();
    for (std::size_t i = 0; i < set.condition.size(); ++i) {
        const ConditionRow& row = set.condition[i];
        Price price;
        price.parameter = row.condition == ConditionRow::Condition::cond1 ? Parameter::cond1_row : Parameter::cond3_row;
        price.steps = row.steps;
        price.active = std::find(active.begin(), active.end(), static_cast<int>(i)) != active.end();
        // A row inactive here may hold the orbit tied with this one.
        if (price.active || record.tied > 1 || !record.refusal.empty()) {
            price.slope = optimum.slope(direction_of(set, price.parameter, static_cast<int>(i)));
        } else {
            price.slope.kind = Slope::Kind::two_sided;
            price.slope.left = price.slope.right = 0.0;
        }
        record.prices.push_back(std::move(price));
    }
    for (const Parameter parameter : whole) {
        if (parameter == Parameter::band) continue;
        record.derivatives.push_back({parameter, optimum.orbit_slope(direction_of(set, parameter))});
    }
    return record;
}

IntervalRecord interval_record(const RelaxedSet& set) {
    const RelaxedInterval interval = relaxed_interval(set);
    IntervalRecord record;
    record.pattern = set.kernel.pattern;
    if (interval.failed || interval.empty) return record;
    record.least = interval.least;
    if (set.gap_sign != 0) {
        const OptimumSensitivity least(set, Objective::min_energy, std::nullopt, interval.least_point);
        record.least_prices = prices_of(set, least, length_and_force);
    }
    if (!interval.unbounded) {
        record.greatest = interval.greatest;
        const OptimumSensitivity greatest(set, Objective::max_energy, std::nullopt, interval.vertices.front());
        record.greatest_prices = prices_of(set, greatest, length_and_force);
    }
    record.mode = mode_of(record.pattern);
    if (record.mode && set.gap_sign != 0) {
        // T/tau = ((2k+1) + delta s)/k^2 with s = sqrt(E_g/E), E_g ~ d^2: s is linear in |d|.
        const double k = *record.mode;
        const double period = record.pattern.period_ratio();
        const double s = 1.0 / std::sqrt(record.least);
        record.frequency_by_gap = -set.gap_sign * s / (k * k * period);
        record.frequency_by_energy = -0.5 * *record.frequency_by_gap;
    }
    return record;
}

}  // namespace nsma
