#include "nsma/report/orbit_json.hpp"

#include <nlohmann/json.hpp>

#include "one_line.hpp"
#include "record_values.hpp"

namespace nsma {
namespace {

// NaN and infinity become null when written.
using Json = nlohmann::ordered_json;

Json json_of(std::monostate) { return nullptr; }
Json json_of(bool value) { return value; }
Json json_of(std::int64_t value) { return value; }
Json json_of(double value) { return value + 0.0; }  // no negative zero
Json json_of(const std::string& text) { return one_line(text); }
Json json_of(const FieldValue& value) {
    return std::visit([](const auto& held) { return json_of(held); }, value);
}

Json json_of(const Eigen::VectorXd& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(json_of(value));
    return list;
}

Json json_of(const SolverRun& run, bool with_seconds) {
    Json solver = {{"name", run.name},
                   {"start", run.start},
                   {"status", run.status},
                   {"objective", run.usable ? json_of(run.objective) : Json()},
                   {"violation", json_of(run.violation)},
                   {"iterations", run.iterations}};
    if (with_seconds) solver["seconds"] = json_of(run.seconds);
    return solver;
}

// Values as the members of an object; the prefix of their names is left out.
Json object(const NamedValues& values, const std::string& prefix, std::initializer_list<const char*> names) {
    Json json = Json::object();
    for (const char* name : names) json[name] = json_of(values.at(prefix + name));
    return json;
}

Json optimality_json(const NamedValues& values) {
    return {{"lower_bound", json_of(values.at("objective_bound"))},
            {"gap", json_of(values.at("objective_gap"))},
            {"global", json_of(values.at("global"))},
            {"kkt_residual", json_of(values.at("kkt_residual"))}};
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
    json["objective"] = {{"name", json_of(values.at("objective"))}, {"value", json_of(values.at("objective_value"))}};
    json["method"] = answer.method;
    json["alpha"] = answer.orbit ? json_of(amplitudes(*answer.orbit)) : Json::array();
    json["violations"] = object(values, "violation_", {"periodicity", "cond1", "cond2", "cond3", "energy"});
    json["classification"] =
        kind ? object(values, "", {"minimal_period_steps", "silent_contact_steps", "wall_touches", "full_support"})
             : Json();
    json.update(
        object(values, "", {"verdict_proved", "proof", "energy_min_exact", "energy_max_exact", "energy_bound"}));
    json["optimality"] = answer.optimality ? optimality_json(values) : Json();
    json["solvers"] = Json::array();
    for (const SolverRun& run : answer.solvers) json["solvers"].push_back(json_of(run, with_seconds));
    json["agreement"] = json_of(values.at("agreement"));
    const double unit = bar.gap_sign() == 0 ? 1.0 : bar.displacement_unit();
    json["tip_displacement"] =
        answer.orbit ? json_of(Eigen::VectorXd(tip_displacement(*answer.orbit) / unit)) : Json::array();
    json["contact_force"] = answer.orbit ? json_of(contact_force(*answer.orbit)) : Json::array();
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace nsma
