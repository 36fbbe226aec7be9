#include "record_values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "nsma/orbit/physical_values.hpp"

namespace nsma {
namespace {

FieldValue value_of(const std::optional<double>& value) { return value ? FieldValue(*value) : FieldValue(); }

FieldValue text_value(const std::string& text) { return text.empty() ? FieldValue() : FieldValue(text); }

void add_energy(NamedValues& values, const Bar& bar, const char* ratio, const char* joule,
                const std::optional<double>& energy) {
    values[ratio] = bar.gap_sign() != 0 ? value_of(energy) : FieldValue();
    values[joule] = energy ? FieldValue(*energy * bar.energy_unit()) : FieldValue();
}

// How good the kept orbit is known to be, in words.
FieldValue proof_value(const OrbitAnswer& answer) {
    if (!answer.orbit) return {};
    if (proved_exactly(answer)) return "proved exactly";
    if (proved_best(answer)) return "proved in floating point";
    const bool bounded = answer.optimality && answer.optimality->lower_bound;
    if (!bounded && !answer.exact_proof) return "no bound";
    const double gap = bounded ? answer.optimality->gap : answer.exact_proof->gap;
    return fmt::format("gap {:.2g} %", 100 * gap);
}

void add_run(NamedValues& values, const char* status, const char* objective, const SolverRun* run) {
    values[status] = run != nullptr ? FieldValue(run->status) : FieldValue();
    values[objective] = run != nullptr && run->usable ? FieldValue(run->objective) : FieldValue();
}

template <class Record>
NamedValues common_values(const Bar& bar, const Record& record) {
    NamedValues values;
    for (const auto& field : fields_of<Record>()) values[field.name] = field.get(record);
    values["gap"] = bar.gap;
    values["period_steps"] = std::int64_t{record.pattern.period_steps()};
    values["frequency_ratio"] = record.pattern.frequency_ratio();
    values["frequency_hz"] = 1.0 / (record.pattern.period_steps() * Mesh{record.pattern.cells}.time_step(bar));
    const EnergyInterval& interval = record.interval;
    add_energy(values, bar, "energy_ratio_min", "energy_min_joule", interval.least);
    add_energy(values, bar, "energy_ratio_max", "energy_max_joule",
               interval.unbounded ? std::nullopt : interval.greatest);
    values["energy_min_exact"] = text_value(interval.least_exact);
    values["energy_max_exact"] = text_value(interval.greatest_exact);
    return values;
}

}  // namespace

NamedValues named_values(const Bar& bar, const PatternRecord& record) { return common_values(bar, record); }

NamedValues named_values(const Bar& bar, const OrbitAnswer& answer) {
    NamedValues values = common_values(bar, answer);
    values["period_s"] = answer.pattern.period_steps() * Mesh{answer.pattern.cells}.time_step(bar);
    add_energy(values, bar, "energy_ratio", "energy_joule", answer.energy);
    for (const char* name : {"peak_force_n", "impact_speed_m_s", "peak_stress_pa", "tip_min_m"}) values[name] = {};
    if (answer.orbit) {
        const PhysicalValues physical = physical_values(*answer.orbit);
        values["peak_force_n"] = physical.peak_force;
        values["impact_speed_m_s"] = physical.impact_speed;
        values["peak_stress_pa"] = physical.peak_stress;
        values["tip_min_m"] = physical.tip_least;
    }
    values["global"] = values["optimum_global"];
    values["proof"] = proof_value(answer);
    if (!answer.optimality || !answer.optimality->lower_bound) values["objective_gap"] = {};
    add_run(values, "ipopt_status", "ipopt_objective", best_run(answer, "ipopt"));
    add_run(values, "nlopt_status", "nlopt_objective", best_run(answer, "nlopt"));
    return values;
}

const SolverRun* best_run(const OrbitAnswer& answer, std::string_view solver) {
    const auto run = std::find_if(answer.solvers.begin(), answer.solvers.end(),
                                  [solver](const SolverRun& candidate) { return candidate.name.starts_with(solver); });
    return run == answer.solvers.end() ? nullptr : &*run;
}

}  // namespace nsma
