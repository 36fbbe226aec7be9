#include "nsma/report/orbit_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "one_line.hpp"

namespace nsma {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value + 0.0) : Json(nullptr); }  // no negative zero

Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json numbers(const Eigen::VectorXd& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number(value));
    return list;
}

Json solver_json(const SolverRun& run, bool with_seconds) {
    Json solver;
    solver["name"] = run.name;
    solver["start"] = run.start;
    solver["status"] = run.status;
    solver["objective"] = run.usable ? number(run.objective) : Json(nullptr);
    solver["violation"] = number(run.violation);
    solver["iterations"] = run.iterations;
    if (with_seconds) solver["seconds"] = number(run.seconds);
    return solver;
}

Json violations_json(const std::optional<Replay>& replay) {
    Json violations;
    const Violations measured = replay ? replay->violations : Violations{};
    const auto set = [&](const char* key, double value) { violations[key] = replay ? number(value) : Json(nullptr); };
    set("periodicity", measured.periodicity);
    set("cond1", measured.cond1);
    set("cond2", measured.cond2);
    set("cond3", measured.cond3);
    set("energy", measured.energy);
    return violations;
}

// Fractions of the energy unit, null without a proof.
Json exact_text(const std::string& fraction) { return fraction.empty() ? Json(nullptr) : Json(fraction); }

Json optimality_json(const std::optional<Optimality>& optimality) {
    if (!optimality) return nullptr;
    return {{"lower_bound", number(optimality->lower_bound)},
            {"gap", optimality->lower_bound ? number(optimality->gap) : Json(nullptr)},
            {"global", optimality->global},
            {"kkt_residual", number(optimality->kkt_residual)}};
}

Json classification_json(const std::optional<Classification>& kind) {
    if (!kind) return nullptr;
    Json object;
    object["minimal_period_steps"] = kind->minimal_period_steps;
    object["silent_contact_steps"] = kind->silent_contact_steps;
    object["wall_touches"] = kind->wall_touches;
    object["full_support"] = kind->full_support;
    return object;
}

Json same_motion_json(const std::optional<Classification>& kind) {
    if (!kind || !kind->same_motion_as) return nullptr;
    const MotionLabel& label = *kind->same_motion_as;
    return {{"free_steps", label.free_steps},
            {"contact_steps", label.contact_steps},
            {"shift_steps", label.shift_steps},
            {"reversed", label.reversed}};
}

}  // namespace

std::string orbit_json(const OrbitAnswer& answer, const Bar& bar, bool with_seconds, int indent) {
    const bool closed = bar.gap_sign() == 0;
    const Pattern& pattern = answer.pattern;
    const auto ratio = [closed](const std::optional<double>& value) { return closed ? Json(nullptr) : number(value); };

    Json json;
    json["cells"] = pattern.cells;
    json["gap"] = number(bar.gap);
    json["free_steps"] = pattern.free_steps;
    json["contact_steps"] = pattern.contact_steps;
    json["kernel_dimension"] = answer.kernel_dimension;
    json["frequency_ratio"] = number(pattern.frequency_ratio());
    json["period_s"] = number(pattern.period_steps() * Mesh{pattern.cells}.time_step(bar));
    json["verdict"] = name(answer.verdict);
    json["kind"] = answer.kind ? Json(name(*answer.kind)) : Json(nullptr);
    json["forceless"] = answer.classification ? Json(answer.classification->forceless) : Json(nullptr);
    json["same_motion_as"] = same_motion_json(answer.classification);
    json["reason"] = one_line(answer.reason);
    json["level"] = number(answer.level);
    json["energy_ratio"] = ratio(answer.energy);
    json["energy_ratio_min"] = ratio(answer.interval.least);
    json["energy_ratio_max"] = answer.interval.unbounded ? Json(nullptr) : ratio(answer.interval.greatest);
    json["energy_joule"] = answer.energy ? number(*answer.energy * bar.energy_unit()) : Json(nullptr);
    json["objective"]["name"] = name(answer.objective);
    json["objective"]["value"] = number(answer.objective_value);
    json["method"] = answer.method;
    json["alpha"] = answer.orbit ? numbers(amplitudes(*answer.orbit)) : Json::array();
    json["violations"] = violations_json(answer.replay);
    json["classification"] = classification_json(answer.classification);
    json["verdict_proved"] = answer.verdict_proved;
    json["energy_min_exact"] = exact_text(answer.interval.least_exact);
    json["energy_max_exact"] = exact_text(answer.interval.greatest_exact);
    json["energy_bound"] = number(answer.interval.bound);
    json["optimality"] = optimality_json(answer.optimality);
    json["solvers"] = Json::array();
    for (const SolverRun& run : answer.solvers) json["solvers"].push_back(solver_json(run, with_seconds));
    json["agreement"] = name(answer.agreement);
    const double unit = closed ? 1.0 : bar.displacement_unit();
    json["tip_displacement"] = answer.orbit ? numbers(tip_displacement(*answer.orbit) / unit) : Json::array();
    json["contact_force"] = answer.orbit ? numbers(contact_force(*answer.orbit)) : Json::array();
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace nsma
