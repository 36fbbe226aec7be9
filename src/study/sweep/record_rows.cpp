#include "record_rows.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nsma {
namespace {

constexpr std::array verdicts{Verdict::trivial,   Verdict::inadmissible, Verdict::below, Verdict::above,
                              Verdict::undecided, Verdict::admissible,   Verdict::failed};
constexpr std::array agreements{Agreement::not_needed, Agreement::agree,       Agreement::different_optimum,
                                Agreement::one_failed, Agreement::both_failed, Agreement::single};
constexpr std::array objectives{Objective::least_shock, Objective::nearest, Objective::least_force,
                                Objective::min_energy, Objective::max_energy};

const auto& all_of(Verdict) { return verdicts; }
const auto& all_of(Agreement) { return agreements; }
const auto& all_of(Objective) { return objectives; }
const auto& all_of(PatternKind) { return pattern_kinds; }

// The fields of each record, once, for writing, reading and naming. A group is an optional part
// whose first field is never without a value.
template <class Record, class Fields>
void pattern_fields(Record& record, Fields& fields) {
    fields("cells", record.pattern.cells);
    fields("free_steps", record.pattern.free_steps);
    fields("contact_steps", record.pattern.contact_steps);
    fields("gap_sign", record.gap_sign);
    fields("kernel_dimension", record.kernel_dimension);
    fields("verdict", record.verdict);
    fields("kind", record.kind);
}

template <class Interval, class Fields>
void interval_fields(Interval& interval, Fields& fields) {
    fields("energy_least", interval.least);
    fields("energy_greatest", interval.greatest);
    fields("energy_bound", interval.bound);
    fields("energy_unbounded", interval.unbounded);
    fields("energy_least_exact", interval.least_exact);
    fields("energy_greatest_exact", interval.greatest_exact);
}

template <class Record, class Fields>
void record_fields(Record& record, Fields& fields) {
    pattern_fields(record, fields);
    interval_fields(record.interval, fields);
    fields("proved", record.proved);
    fields("reason", record.reason);
    fields("seconds", record.seconds);
}

std::optional<MotionLabel> same_motion_of(const OrbitAnswer& answer) {
    return answer.classification ? answer.classification->same_motion_as : std::nullopt;
}

template <class Answer, class Fields>
void answer_fields(Answer& answer, Fields& fields) {
    pattern_fields(answer, fields);
    interval_fields(answer.interval, fields);
    fields("verdict_proved", answer.verdict_proved);
    fields("reason", answer.reason);
    fields("level", answer.level);
    fields("objective", answer.objective);
    fields("objective_value", answer.objective_value);
    fields("objective_difference", answer.objective_difference);
    fields("method", answer.method);
    fields("agreement", answer.agreement);
    fields("energy", answer.energy);
    fields.group(answer.optimality, [&](auto& optimality) {
        fields("optimum_global", optimality.global);
        fields("objective_bound", optimality.lower_bound);
        fields("objective_gap", optimality.gap);
        fields("kkt_residual", optimality.kkt_residual);
    });
    fields.group(answer.replay, [&](auto& replay) {
        fields("replay_accepted", replay.accepted);
        fields("replay_same_labels", replay.same_labels);
        fields("violation_periodicity", replay.violations.periodicity);
        fields("violation_cond1", replay.violations.cond1);
        fields("violation_cond2", replay.violations.cond2);
        fields("violation_cond3", replay.violations.cond3);
        fields("violation_energy", replay.violations.energy);
    });
    fields.group(answer.classification, [&](auto& kind) {
        fields("minimal_period_steps", kind.minimal_period_steps);
        fields("silent_contact_steps", kind.silent_contact_steps);
        fields("wall_touches", kind.wall_touches);
        fields("forceless", kind.forceless);
        fields("full_support", kind.full_support);
        fields("classification_tolerance", kind.tolerance);
    });
    auto same = same_motion_of(answer);
    fields.group(same, [&](auto& label) {
        fields("same_free_steps", label.free_steps);
        fields("same_contact_steps", label.contact_steps);
        fields("same_shift_steps", label.shift_steps);
        fields("same_reversed", label.reversed);
    });
    if constexpr (!std::is_const_v<Answer>) {
        if (answer.classification) answer.classification->same_motion_as = same;
    }
    fields("seconds", answer.seconds);
}

template <class Run, class Fields>
void run_fields(Run& run, Fields& fields) {
    fields("solver", run.name);
    fields("start", run.start);
    fields("status", run.status);
    fields("usable", run.usable);
    fields("objective", run.objective);
    fields("violation", run.violation);
    fields("iterations", run.iterations);
    fields("seconds", run.seconds);
}

class Names {
public:
    std::vector<std::string> names;
    template <class Field>
    void operator()(const char* name, const Field&) {
        names.emplace_back(name);
    }
    template <class Part, class Visit>
    void group(const std::optional<Part>&, Visit visit) {
        const Part none{};
        visit(none);
    }
};

class Writer {
public:
    Row row;
    void operator()(const char*, int value) { put(std::int64_t{value}); }
    void operator()(const char*, bool value) { put(std::int64_t{value ? 1 : 0}); }
    void operator()(const char*, double value) {
        if (std::isnan(value)) {
            put(std::monostate{});
        } else {
            put(value);
        }
    }
    void operator()(const char*, const std::string& value) { put(value); }
    void operator()(const char* name, const std::optional<double>& value) {
        if (value) {
            (*this)(name, *value);
        } else {
            put(std::monostate{});
        }
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(const char*, Enum value) { put(std::string(name(value))); }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(const char* name, const std::optional<Enum>& value) {
        if (value) {
            (*this)(name, *value);
        } else {
            put(std::monostate{});
        }
    }
    template <class Part, class Visit>
    void group(const std::optional<Part>& part, Visit visit) {
        const Part none{};
        absent_ = !part.has_value();
        visit(part ? *part : none);
        absent_ = false;
    }

private:
    void put(Value value) { row.push_back(absent_ ? Value{} : std::move(value)); }
    bool absent_ = false;
};

class Reader {
public:
    explicit Reader(const Row& row) : row_(row) {}

    void operator()(const char* name, int& value) {
        const auto whole = get<std::int64_t>(name);
        if (whole < std::numeric_limits<int>::min() || whole > std::numeric_limits<int>::max()) fail(name);
        value = static_cast<int>(whole);
    }
    void operator()(const char* name, bool& value) { value = get<std::int64_t>(name) != 0; }
    void operator()(const char* name, double& value) {
        std::optional<double> number;
        (*this)(name, number);
        value = number.value_or(std::numeric_limits<double>::quiet_NaN());
    }
    void operator()(const char* name, std::string& value) { value = get<std::string>(name); }
    void operator()(const char* name, std::optional<double>& value) {
        const Value& got = peek(name);
        if (std::holds_alternative<std::monostate>(got)) {
            ++next_;
            value.reset();
        } else {
            value = get<double>(name);
        }
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(const char* what, Enum& value) {
        const auto word = get<std::string>(what);
        for (const Enum candidate : all_of(Enum{})) {
            if (name(candidate) == word) {
                value = candidate;
                return;
            }
        }
        fail(what);
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(const char* name, std::optional<Enum>& value) {
        if (std::holds_alternative<std::monostate>(peek(name))) {
            ++next_;
            value.reset();
        } else {
            (*this)(name, value.emplace());
        }
    }
    template <class Part, class Visit>
    void group(std::optional<Part>& part, Visit visit) {
        const bool absent = std::holds_alternative<std::monostate>(peek("group"));
        skip_ = absent;
        visit(part.emplace());
        skip_ = false;
        if (absent) part.reset();
    }
    void end() const {
        if (next_ != row_.size())
            throw std::invalid_argument("row: expected " + std::to_string(next_) + " values, got " +
                                        std::to_string(row_.size()));
    }

private:
    [[noreturn]] static void fail(const char* name) {
        throw std::invalid_argument(std::string(name) + ": expected a value of its kind, got another");
    }
    const Value& peek(const char* name) const {
        if (next_ >= row_.size()) fail(name);
        return row_[next_];
    }
    template <class Kind>
    Kind get(const char* name) {
        const Value& value = peek(name);
        ++next_;
        if (skip_) return {};
        if (const Kind* kind = std::get_if<Kind>(&value)) return *kind;
        fail(name);
    }

    const Row& row_;
    std::size_t next_ = 0;
    bool skip_ = false;  // in a part that is absent
};

}  // namespace

std::vector<std::string> pattern_columns() {
    Names names;
    const PatternRecord record;
    record_fields(record, names);
    return names.names;
}

std::vector<std::string> answer_columns() {
    Names names;
    const OrbitAnswer answer;
    answer_fields(answer, names);
    return names.names;
}

std::vector<std::string> run_columns() {
    Names names;
    const SolverRun run;
    run_fields(run, names);
    return names.names;
}

ResultRows rows_of(const WorkResult& result) {
    ResultRows rows;
    if (result.record) {
        Writer writer;
        record_fields(*result.record, writer);
        rows.pattern = std::move(writer.row);
    }
    if (result.answer) {
        Writer writer;
        answer_fields(*result.answer, writer);
        rows.answer = std::move(writer.row);
        for (const SolverRun& run : result.answer->solvers) {
            Writer one;
            run_fields(run, one);
            rows.runs.push_back(std::move(one.row));
        }
        if (const auto& orbit = result.answer->orbit) {
            rows.beta.assign(orbit->beta.data(), orbit->beta.data() + orbit->beta.size());
        }
    }
    return rows;
}

PatternRecord pattern_record_of(const Row& row) {
    PatternRecord record;
    Reader reader(row);
    record_fields(record, reader);
    reader.end();
    return record;
}

OrbitAnswer orbit_answer_of(const ResultRows& rows, const Bar& bar) {
    OrbitAnswer answer;
    Reader reader(rows.answer);
    answer_fields(answer, reader);
    reader.end();
    for (const Row& row : rows.runs) {
        Reader one(row);
        run_fields(answer.solvers.emplace_back(), one);
        one.end();
    }
    if (!rows.beta.empty()) {
        answer.orbit = make_orbit(
            bar, exact_kernel(answer.pattern),
            Eigen::Map<const Eigen::VectorXd>(rows.beta.data(), static_cast<Eigen::Index>(rows.beta.size())));
    }
    return answer;
}

}  // namespace nsma
