#include "report_page.hpp"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "page_parts.hpp"

#include "nsma/report/scene_file.hpp"
#include "report/bar_text.hpp"
#include "report/json_values.hpp"
#include "report/record_values.hpp"
#include "report/results_folder.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"
#include "report/study_records.hpp"
#include "report/sweep/seen_motions.hpp"
#include "report/sweep/sweep_folder.hpp"
#include "report/sweep/sweep_store.hpp"
#include "report/sweep/tables.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The columns of a pattern and of an answer on the page, by the names of the tables.
constexpr std::array pattern_fields{
    "free_steps",      "contact_steps",    "kernel_dimension", "verdict",          "kind",  "energy_least",
    "energy_greatest", "energy_unbounded", "energy_min_exact", "energy_max_exact", "proved"};
constexpr std::size_t reason_field = 4;
// Of a page that a browser still opens at once; the tables have all.
constexpr std::size_t most_rows = 100'000;
constexpr std::size_t most_amplitudes = 2'000'000;

constexpr std::array answer_fields{"free_steps",
                                   "contact_steps",
                                   "level",
                                   "verdict",
                                   "reason",
                                   "energy",
                                   "objective_value",
                                   "objective_gap",
                                   "method",
                                   "agreement",
                                   "global",
                                   "proof",
                                   "forceless",
                                   "violation_cond1",
                                   "violation_cond2",
                                   "violation_cond3",
                                   "minimal_period_steps",
                                   "same_free_steps",
                                   "same_contact_steps",
                                   "peak_force_n",
                                   "impact_speed_m_s",
                                   "peak_stress_pa",
                                   "tip_min_m"};

template <std::size_t Size>
Json row_json(const std::array<const char*, Size>& names, const NamedValues& values) {
    Json row = Json::array();
    for (const char* name : names) row.push_back(value_json(values.at(name)));
    return row;
}

Json bar_json(const Bar& bar) {
    return {{"length", bar.length},
            {"area", bar.area},
            {"gap", bar.gap},
            {"without_units", is_unit_bar(bar)},
            {"gap_sign", bar.gap_sign()},
            {"impedance", bar.impedance()},
            {"travel_time", bar.travel_time()},
            {"displacement_unit", bar.displacement_unit()},
            {"energy_unit", bar.energy_unit()},
            {"first_frequency", 0.25 / bar.travel_time()}};
}

Json runs_json(const OrbitAnswer& answer) {
    Json runs = Json::array();
    for (const SolverRun& run : answer.solvers) {
        runs.push_back({{"name", run.name},
                        {"start", run.start},
                        {"status", run.status},
                        {"objective", run.usable ? Json(run.objective) : Json()},
                        {"iterations", run.iterations}});
    }
    return runs;
}

// Of the orbits of a study in the same folder: in SI units, of whole conditions.
Json prices_json(const fs::path& folder) {
    Json prices = Json::array();
    if (std::error_code code; !fs::exists(folder / sensitivity_records_name, code)) return prices;
    Scene scene = read_scene(folder / "scene.toml");
    for (const OptimumRecord& record : read_sensitivity_records(folder, scene).optima) {
        Json rows = Json::array();
        for (const Price& price : record.prices) {
            if (!price.steps.empty() || !price.slope.right || !price.slope.left) continue;
            const auto si = [&](double side) { return in_si(side, record.objective, price.parameter, scene.bar); };
            rows.push_back({{"name", name(price.parameter)},
                            {"unit", unit_name(price.parameter)},
                            {"active", price.active},
                            {"above", si(*price.slope.right)},
                            {"below", si(*price.slope.left)}});
        }
        const Pattern& pattern = record.orbit.kernel.pattern;
        prices.push_back({{"free_steps", pattern.free_steps},
                          {"contact_steps", pattern.contact_steps},
                          {"level", record.level ? Json(*record.level) : Json()},
                          {"objective", name(record.objective)},
                          {"unit", objective_unit(record.objective, scene.bar).second},
                          {"refusal", record.refusal},
                          {"prices", std::move(rows)}});
    }
    return prices;
}

Json sweep_json(const SweepStore& store, const fs::path& folder, SweepSummary& summary) {
    const Scene& scene = store.scene();
    Json patterns = Json::array();
    Json answers = Json::array();
    std::size_t amplitudes = 0;
    long left_out = 0;
    SeenMotions seen;
    store.for_each([&](const WorkResult& result) {
        if (result.record) {
            count(summary, *result.record, scene.all_kinds);
            if (result.record->verdict == Verdict::admissible)
                patterns.push_back(row_json(pattern_fields, named_values(scene.bar, *result.record)));
        }
        if (!result.answer) return;
        const OrbitAnswer& answer = *result.answer;
        count(summary, answer, result.place > 0);
        const bool copy = seen.before(answer, result.place);
        if (copy && result.place > 0) ++summary.copies;
        amplitudes += answer.orbit ? static_cast<std::size_t>(answer.orbit->beta.size()) : 0;
        if (answers.size() >= most_rows || amplitudes > most_amplitudes) {
            ++left_out;
            return;
        }
        Json row = row_json(answer_fields, named_values(scene.bar, answer));
        if (answer.orbit) {
            row.push_back(copy);
            row.push_back(runs_json(answer));
            row.push_back(value_json(answer.orbit->beta));
        } else {  // most rows of many sweeps: no more than they say
            if (answer.verdict == Verdict::below || answer.verdict == Verdict::above) row[reason_field] = nullptr;
            while (row.back().is_null()) row.erase(row.size() - 1);
        }
        answers.push_back(std::move(row));
    });
    summary.seconds = store.seconds();
    summary.interrupted = !store.complete();
    Json fields = answer_fields;
    for (const char* field : {"copy", "solvers", "beta"}) fields.push_back(field);
    return {{"bar", bar_json(scene.bar)},
            {"cells", scene.mesh.cells},
            {"objective", name(scene.objective)},
            {"objective_unit", objective_unit(scene.objective, scene.bar)},
            {"levels", scene.levels},
            {"pattern_fields", pattern_fields},
            {"patterns", std::move(patterns)},
            {"answer_fields", std::move(fields)},
            {"answers", std::move(answers)},
            {"left_out", left_out},
            {"prices", prices_json(folder)}};
}

Json accuracy_json(const AccuracyResults& results) {
    Json programs = Json::array();
    Json stability = Json::array();
    const auto common = [](const MethodRuns& runs) {
        return Json{{"method", runs.method},
                    {"size", runs.size},
                    {"runs", runs.runs},
                    {"certified", runs.certified},
                    {"outcomes", runs.outcomes}};
    };
    for (const ProgramRecord& record : results.programs) {
        Json program = common(record);
        program["setting"] = record.setting;
        program["error"] = record.error;  // infinity becomes null
        program["seconds"] = record.seconds.median;
        programs.push_back(std::move(program));
    }
    for (const StabilityRecord& record : results.stability) {
        Json cell = common(record);
        cell["map"] = record.map;
        cell["column"] = record.column;
        cell["difficulty"] = record.difficulty;
        stability.push_back(std::move(cell));
    }
    Json outcomes = Json::array();
    Json meanings = Json::array();
    for (int i = 0; i < outcome_count; ++i) {
        outcomes.push_back(name(static_cast<Outcome>(i)));
        meanings.push_back(description(static_cast<Outcome>(i)));
    }
    return {{"programs", std::move(programs)},
            {"stability", std::move(stability)},
            {"outcomes", std::move(outcomes)},
            {"meanings", std::move(meanings)}};
}

// In an element of script nothing but its end, or a comment, begins with this character.
std::string within_script(const Json& data) {
    std::string text;
    for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    }
    return text;
}

std::string filled(const std::string& data) {
    std::string page;
    const auto append = [&page](const std::vector<std::string_view>& files) {
        for (const std::string_view file : files) page += file;
    };
    std::string_view rest = page_html.front();
    for (std::size_t at = rest.find('@'); at != std::string_view::npos; at = rest.find('@')) {
        page += rest.substr(0, at);
        const std::size_t end = rest.find('@', at + 1);
        const std::string_view part = rest.substr(at + 1, end - at - 1);
        if (part == "DATA")
            page += data;
        else
            append(part == "STYLE"     ? page_style
                   : part == "LICENCE" ? page_licence
                   : part == "VENDOR"  ? page_vendor
                                       : page_script);
        rest = rest.substr(end + 1);
    }
    page += rest;
    return page;
}

}  // namespace

std::string report_page(const fs::path& folder, const std::string& program) {
    const auto holds = [&folder](const char* file) {
        std::error_code code;
        const bool found = fs::exists(folder / file, code);
        if (code) fail(folder / file, fmt::format("cannot be read: {}", code.message()));
        return found;
    };
    expect_folder(folder, "the folder of a sweep or of an accuracy study");
    const bool sweep = holds(store_name) || holds(store_part_name);
    const bool accuracy = holds(accuracy_records_name);
    if (!sweep && !accuracy) {
        fail(folder, fmt::format("expected the folder of a sweep or of an accuracy study, got one without {} and {}",
                                 store_name, accuracy_records_name));
    }
    Json data = Json::object();
    data["program"] = program;
    Scene scene;
    std::string summary_text;
    if (sweep) {
        const SweepStore store(folder);
        SweepSummary summary;
        data["sweep"] = sweep_json(store, folder, summary);
        scene = store.scene();
        summary_text = summary_table(summary);
    } else {
        scene = read_scene(folder / "scene.toml");
    }
    if (accuracy) data["accuracy"] = accuracy_json(read_accuracy_records(folder));
    data["title"] = scene.title;
    data["derived"] = derived_text(scene);
    data["scene"] = scene.text;
    data["summary"] = summary_text;
    return filled(within_script(data));
}

}  // namespace nsma
