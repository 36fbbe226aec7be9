#include "nsma/report/orbit_json.hpp"

#include <nlohmann/json.hpp>

#include "json_values.hpp"
#include "record_values.hpp"

namespace nsma {
namespace {

using Json = nlohmann::ordered_json;

Json run_json(const SolverRun& run, bool with_seconds) {
    Json solver = {{"name", run.name},
                   {"start", run.start},
                   {"status", run.status},
                   {"objective", run.usable ? value_json(run.objective) : Json()},
                   {"violation", value_json(run.violation)},
                   {"iterations", run.iterations}};
    if (with_seconds) solver["seconds"] = value_json(run.seconds);
    return solver;
}

// Values as the members of an object; the prefix of their names is left out.
Json object(const NamedValues& values, const std::string& prefix, std::initializer_list<const char*> names) {
    Json json = Json::object();
    for (const char* name : names) json[name] = value_json(values.at(prefix + name));
    return json;
}

Json optimality_json(const NamedValues& values) {
    return {{"lower_bound", value_json(values.at("objective_bound"))},
            {"gap", value_json(values.at("objective_gap"))},
            {"global", value_json(values.at("global"))},
            {"kkt_residual", value_json(values.at("kkt_residual"))}};
}

}  // namespace

std::string orbit_json(const OrbitAnswer& answer, const Bar& bar, bool with_seconds, int indent) {
    const NamedValues values = named_values(bar, answer);
    const auto& kind = answer.classification;
    Json json = object(values, "",
                       {"cells", "gap", "free_steps", "contact_steps", "kernel_dimension", "frequency_ratio",
                        "period_s", "verdict", "kind", "forceless"});
    json["same_motion_as"] = kind && kind->same_motion_as
                                 ? object(values, "same_", {"free_steps", "contact_steps", "shift_steps", "reversed"})
                                 : Json();
    json.update(object(values, "",
                       {"reason", "level", "energy_ratio", "energy_ratio_min", "energy_ratio_max", "energy_joule",
                        "frequency_hz", "peak_force_n", "impact_speed_m_s", "peak_stress_pa", "tip_min_m"}));
    json["objective"] = {{"name", value_json(values.at("objective"))},
                         {"value", value_json(values.at("objective_value"))}};
    json["method"] = answer.method;
    json["alpha"] = answer.orbit ? value_json(amplitudes(*answer.orbit)) : Json::array();
    json["violations"] = object(values, "violation_", {"periodicity", "cond1", "cond2", "cond3", "energy"});
    json["classification"] =
        kind ? object(values, "", {"minimal_period_steps", "silent_contact_steps", "wall_touches", "full_support"})
             : Json();
    json.update(
        object(values, "", {"verdict_proved", "proof", "energy_min_exact", "energy_max_exact", "energy_bound"}));
    json["optimality"] = answer.optimality ? optimality_json(values) : Json();
    json["solvers"] = Json::array();
    for (const SolverRun& run : answer.solvers) json["solvers"].push_back(run_json(run, with_seconds));
    json["agreement"] = value_json(values.at("agreement"));
    const double unit = bar.gap_sign() == 0 ? 1.0 : bar.displacement_unit();
    json["tip_displacement"] =
        answer.orbit ? value_json(Eigen::VectorXd(tip_displacement(*answer.orbit) / unit)) : Json::array();
    json["contact_force"] = answer.orbit ? value_json(contact_force(*answer.orbit)) : Json::array();
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace nsma
