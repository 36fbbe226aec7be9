#include "study_records.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "input_file.hpp"
#include "json_numbers.hpp"
#include "nesting.hpp"
#include "results_folder.hpp"
#include "nsma/orbit/kernel.hpp"
#include "orbit/fnv_hash.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int records_format = 1;
constexpr int deepest_records = 16;
constexpr std::size_t most_records_bytes = std::size_t{1} << 30U;

// The members of every record, by name: visited to write them and to read them.
template <class Value, class Wanted>
concept Record = std::is_same_v<std::remove_const_t<Value>, Wanted>;

template <class Visit, Record<Pattern> Of>
void members(Visit& visit, Of& record) {
    visit("cells", record.cells);
    visit("free_steps", record.free_steps);
    visit("contact_steps", record.contact_steps);
}

template <class Visit, Record<Spread> Of>
void members(Visit& visit, Of& record) {
    visit("median", record.median);
    visit("low", record.low);
    visit("high", record.high);
}

template <class Visit, Record<MethodRuns> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.pattern);
    visit("size", record.size);
    visit("method", record.method);
    visit("runs", record.runs);
    visit("reported", record.reported);
    visit("false_success", record.false_success);
    visit("certified", record.certified);
    visit("outcomes", record.outcomes);
    visit("proved", record.proved);
    visit("iterations", record.iterations);
}

MethodRuns& base(MethodRuns& record) { return record; }
const MethodRuns& base(const MethodRuns& record) { return record; }

template <class Visit, Record<ProgramRecord> Of>
void members(Visit& visit, Of& record) {
    members(visit, base(record));
    visit("setting", record.setting);
    visit("warm", record.warm);
    visit("seconds", record.seconds);
    visit("worst_gap", record.worst_gap);
    visit("worst_violation", record.worst_violation);
    visit("error", record.error);
}

template <class Visit, Record<StabilityRecord> Of>
void members(Visit& visit, Of& record) {
    members(visit, base(record));
    visit("map", record.map);
    visit("column", record.column);
    visit("difficulty", record.difficulty);
    visit("above_least", record.above_least);
    visit("below_greatest", record.below_greatest);
    visit("seconds", record.seconds);
}

template <class Visit, Record<KernelRecord> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.pattern);
    visit("method", record.method);
    visit("seconds", record.seconds);
    visit("dimension", record.dimension);
    visit("expected", record.expected);
    visit("error", record.error);
}

template <class Visit, Record<MarchRecord> Of>
void members(Visit& visit, Of& record) {
    visit("cells", record.cells);
    visit("method", record.method);
    visit("setting", record.setting);
    visit("decides_contact", record.decides_contact);
    visit("steps", record.steps);
    visit("seconds", record.seconds);
    visit("tip_error", record.tip_error);
    visit("contact_error", record.contact_error);
}

template <class Visit, Record<DriftRecord> Of>
void members(Visit& visit, Of& record) {
    visit("cells", record.cells);
    visit("method", record.method);
    visit("setting", record.setting);
    visit("periods", record.periods);
    visit("energy_drift", record.energy_drift);
    visit("periodicity_defect", record.periodicity_defect);
    visit("seconds", record.seconds);
}

template <class Visit, Record<ToleranceRecord> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.pattern);
    visit("method", record.method);
    visit("tolerance", record.tolerance);
    visit("found", record.found);
    visit("expected", record.expected);
}

template <class Visit, Record<AccuracyResults> Of>
void members(Visit& visit, Of& records) {
    visit("programs", records.programs);
    visit("kernels", records.kernels);
    visit("marches", records.marches);
    visit("drifts", records.drifts);
    visit("stability", records.stability);
    visit("tolerances", records.tolerances);
}

template <class Visit, Record<Slope> Of>
void members(Visit& visit, Of& record) {
    visit("kind", record.kind);
    visit("right", record.right);
    visit("left", record.left);
    visit("right_root", record.right_root);
    visit("left_root", record.left_root);
    visit("reason", record.reason);
}

template <class Visit, Record<Price> Of>
void members(Visit& visit, Of& record) {
    visit("parameter", record.parameter);
    visit("steps", record.steps);
    visit("active", record.active);
    visit("slope", record.slope);
}

template <class Visit, Record<OrbitDerivative> Of>
void members(Visit& visit, Of& record) {
    visit("parameter", record.parameter);
    visit("beta", record.slope.beta);
    visit("reason", record.slope.reason);
}

template <class Visit, Record<OptimumRecord> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.orbit.kernel.pattern);
    visit("beta", record.orbit.beta);
    visit("objective", record.objective);
    visit("level", record.level);
    visit("value", record.value);
    visit("global", record.global);
    visit("nondegenerate", record.nondegenerate);
    visit("tied", record.tied);
    visit("refusal", record.refusal);
    visit("kkt_residual", record.kkt_residual);
    visit("euler_defect", record.euler_defect);
    visit("prices", record.prices);
    visit("derivatives", record.derivatives);
}

template <class Visit, Record<IntervalRecord> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.pattern);
    visit("least", record.least);
    visit("greatest", record.greatest);
    visit("least_prices", record.least_prices);
    visit("greatest_prices", record.greatest_prices);
    visit("mode", record.mode);
    visit("frequency_by_energy", record.frequency_by_energy);
    visit("frequency_by_energy_difference", record.frequency_by_energy_difference);
    visit("frequency_by_gap", record.frequency_by_gap);
    visit("frequency_by_gap_difference", record.frequency_by_gap_difference);
}

template <class Visit, Record<CurveRecord> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.pattern);
    visit("relaxed", record.relaxed);
    visit("amount", record.amount);
    visit("failed", record.failed);
    visit("admissible", record.admissible);
    visit("least", record.least);
    visit("greatest", record.greatest);
    visit("unbounded", record.unbounded);
    visit("level", record.level);
    visit("objective", record.objective);
}

template <class Visit, Record<AblationRecord> Of>
void members(Visit& visit, Of& record) {
    visit("pattern", record.pattern);
    visit("kernel_dimension", record.kernel_dimension);
    visit("kind", record.kind);
    visit("survives", record.survives);
}

template <class Visit, Record<SensitivitySummary> Of>
void members(Visit& visit, Of& record) {
    visit("patterns", record.patterns);
    visit("admissible", record.admissible);
    visit("optima", record.optima);
    visit("left", record.left);
    visit("nondegenerate", record.nondegenerate);
    visit("tied", record.tied);
    visit("refused", record.refused);
    visit("failed", record.failed);
    visit("worst_euler", record.worst_euler);
    visit("worst_kkt", record.worst_kkt);
    visit("worst_frequency", record.worst_frequency);
    visit("interrupted", record.interrupted);
}

template <class Visit, Record<SensitivityRecords> Of>
void members(Visit& visit, Of& records) {
    visit("optima", records.optima);
    visit("intervals", records.intervals);
    visit("curves", records.curves);
    visit("ablations", records.ablations);
    visit("summary", records.summary);
}

// Records and the objective that the scene had.
struct Sensitivity {
    Objective objective = Objective::least_shock;
    SensitivityRecords records;
};
template <class Visit, Record<Sensitivity> Of>
void members(Visit& visit, Of& study) {
    visit("scene_objective", study.objective);
    visit("records", study.records);
}

template <class Value>
concept List = requires(const Value& value) {
    value.begin();
    value.size();
}
&&!std::is_same_v<Value, std::string>;

// What JSON has no number for stands there as a word.
struct Writer {
    Json json = Json::object();

    template <class Value>
    void operator()(const char* name, const Value& value) {
        json[name] = json_of(value);
    }

    template <class Value>
    static Json json_of(const Value& value) {
        if constexpr (std::is_same_v<Value, double>) {
            return std::isfinite(value) ? Json(value) : Json(fmt::format("{}", value));
        } else if constexpr (std::is_enum_v<Value>) {
            return static_cast<int>(value);
        } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
            return value;
        } else if constexpr (requires { value.has_value(); }) {
            return value ? json_of(*value) : Json();
        } else if constexpr (List<Value>) {
            Json list = Json::array();
            for (const auto& item : value) list.push_back(json_of(item));
            return list;
        } else {
            Writer writer;
            members(writer, value);
            return std::move(writer.json);
        }
    }
};

double not_finite(const std::string& word) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (word == "inf" || word == "-inf") return word == "inf" ? infinity : -infinity;
    if (word != "nan" && word != "-nan") throw std::invalid_argument("number");
    return std::numeric_limits<double>::quiet_NaN();
}

constexpr Slope::Kind last_of(Slope::Kind) { return Slope::Kind::refused; }
constexpr Parameter last_of(Parameter) { return Parameter::energy; }
constexpr Objective last_of(Objective) { return Objective::max_energy; }
constexpr PatternKind last_of(PatternKind) { return pattern_kinds.back(); }

// The inverse. Throws nlohmann's exceptions and std::exception where the JSON is of other records.
struct Reader {
    const Json& json;

    template <class Value>
    void operator()(const char* name, Value& value) {
        read(json.at(name), value);
    }

    template <class Value>
    static void read(const Json& from, Value& value) {
        if constexpr (std::is_same_v<Value, double>) {
            value = from.is_string() ? not_finite(from.get<std::string>()) : from.get<double>();
        } else if constexpr (std::is_enum_v<Value>) {
            const int number = whole_number(from);
            if (number < 0 || number > static_cast<int>(last_of(Value{}))) throw std::invalid_argument("name");
            value = static_cast<Value>(number);
        } else if constexpr (std::is_same_v<Value, int>) {
            value = whole_number(from);
        } else if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Value, std::string>) {
            value = from.get<Value>();
        } else if constexpr (requires { value.has_value(); }) {
            value.reset();
            if (!from.is_null()) read(from, value.emplace());
        } else if constexpr (List<Value>) {
            if constexpr (requires { value.resize(0); }) value.resize(static_cast<decltype(value.size())>(from.size()));
            if (static_cast<std::size_t>(value.size()) != from.size()) throw std::invalid_argument("list");
            auto item = from.begin();
            for (auto& one : value) read(*item++, one);
        } else {
            Reader reader{from};
            members(reader, value);
        }
    }
};

std::string checksum(const std::string& text) {
    FnvHash hash;
    for (const char letter : text) hash.add(static_cast<unsigned char>(letter));
    return fmt::format("{:016x}", hash.value());
}

void write(const fs::path& file, Json records) {
    auto json = Json::object();
    json["format"] = records_format;
    json["checksum"] = checksum(records.dump());
    json["records"] = std::move(records);
    write_whole(file, json.dump() + "\n");
}

template <class Records>
Records records_in(const fs::path& file) {
    const std::string text = InputFile(file, "the records of a study").text(most_records_bytes);
    if (too_deep(text, deepest_records)) fail(file, "expected the records of a study, got brackets nested too deep");
    const Json json = Json::parse(text, nullptr, false);
    const bool known = json.is_object() && json.contains("records") && json.contains("checksum") &&
                       json.contains("format") && json["format"] == records_format;
    if (!known) fail(file, fmt::format("expected the records of a study in format {}, got other text", records_format));
    if (json["checksum"] != checksum(json["records"].dump())) fail(file, "is damaged: its checksum does not fit");
    try {
        Records records;
        Reader::read(json["records"], records);
        return records;
    } catch (const std::exception&) {
        fail(file, "expected the records of a study, got others");
    }
}

}  // namespace

void write_records(const fs::path& folder, const AccuracyResults& results) {
    write(folder / accuracy_records_name, Writer::json_of(results));
}

void write_records(const fs::path& folder, const Scene& scene, const SensitivityRecords& records) {
    auto study = Json::object();
    study["scene_objective"] = Writer::json_of(scene.objective);
    study["records"] = Writer::json_of(records);
    write(folder / sensitivity_records_name, std::move(study));
}

AccuracyResults read_accuracy_records(const fs::path& folder) {
    constexpr int most_columns = 1000;
    const fs::path file = folder / accuracy_records_name;
    auto results = records_in<AccuracyResults>(file);
    for (const StabilityRecord& record : results.stability) {
        if (record.column < 0 || record.column >= most_columns)
            fail(file, fmt::format("column: expected 0..{}, got {}", most_columns - 1, record.column));
    }
    return results;
}

SensitivityRecords read_sensitivity_records(const fs::path& folder, Scene& scene) {
    const fs::path file = folder / sensitivity_records_name;
    auto study = records_in<Sensitivity>(file);
    scene.objective = study.objective;
    for (OptimumRecord& record : study.records.optima) {
        const Pattern pattern = record.orbit.kernel.pattern;
        try {
            validate(pattern);
            if (pattern.cells != scene.mesh.cells || record.orbit.beta.size() != kernel_dimension(pattern))
                throw std::invalid_argument("another mesh or number of amplitudes");
            record.orbit = make_orbit(scene.bar, exact_kernel(pattern), record.orbit.beta);
            for (const Price& price : record.prices) {
                for (const int step : price.steps) {
                    if (step < 0 || step > pattern.period_steps())
                        throw std::invalid_argument(fmt::format("a price at step {}", step));
                }
            }
        } catch (const std::invalid_argument& error) {
            fail(file, fmt::format("expected orbits of the scene, got one with {}", error.what()));
        }
    }
    return std::move(study.records);
}

}  // namespace nsma
