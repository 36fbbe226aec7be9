#include "record_fields.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

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

template <class Type>
constexpr bool is_optional = false;
template <class Type>
constexpr bool is_optional<std::optional<Type>> = true;

FieldValue value_of(bool value) { return value; }
FieldValue value_of(int value) { return std::int64_t{value}; }
FieldValue value_of(double value) { return std::isnan(value) ? FieldValue() : FieldValue(value); }
FieldValue value_of(const std::string& value) { return value; }
template <class Enum>
requires std::is_enum_v<Enum> FieldValue value_of(Enum value) { return std::string(name(value)); }
template <class Type>
FieldValue value_of(const std::optional<Type>& value) {
    return value ? value_of(*value) : FieldValue();
}

template <class Type>
bool read(const FieldValue& value, Type& field) {
    const auto* whole = std::get_if<std::int64_t>(&value);
    if constexpr (is_optional<Type>) {
        field.reset();
        return std::holds_alternative<std::monostate>(value) || read(value, field.emplace());
    } else if constexpr (std::is_enum_v<Type>) {
        const auto* word = std::get_if<std::string>(&value);
        for (const Type candidate : all_of(Type{})) {
            if (word == nullptr || name(candidate) != *word) continue;
            field = candidate;
            return true;
        }
        return false;
    } else if constexpr (std::is_same_v<Type, int>) {
        if (whole == nullptr || *whole != static_cast<std::int64_t>(static_cast<int>(*whole))) return false;
        field = static_cast<int>(*whole);
        return true;
    } else if (const auto* same = std::get_if<Type>(&value)) {
        field = *same;
        return true;
    } else if constexpr (std::is_same_v<Type, bool>) {
        if (whole == nullptr) return false;
        field = *whole != 0;  // as SQLite has it
        return true;
    } else if constexpr (std::is_same_v<Type, double>) {
        field = std::numeric_limits<double>::quiet_NaN();
        return std::holds_alternative<std::monostate>(value);
    } else {
        return false;
    }
}

// The member that a path of members leads to; null where an optional part on the way is absent.
template <auto Member, auto... Rest, class Owner>
const auto* find(const Owner& owner) {
    const auto& part = owner.*Member;
    if constexpr (sizeof...(Rest) == 0) {
        return &part;
    } else if constexpr (is_optional<std::decay_t<decltype(part)>>) {
        return part ? find<Rest...>(*part) : nullptr;
    } else {
        return find<Rest...>(part);
    }
}

// The same, with the parts on the way made where they are absent.
template <auto Member, auto... Rest, class Owner>
auto& make(Owner& owner) {
    auto& part = owner.*Member;
    if constexpr (sizeof...(Rest) == 0) {
        return part;
    } else if constexpr (is_optional<std::decay_t<decltype(part)>>) {
        return make<Rest...>(part ? *part : part.emplace());
    } else {
        return make<Rest...>(part);
    }
}

// A part without a value is absent; the first field of each part always has one.
template <class Record, auto... Path>
RecordField<Record> member(const char* name) {
    const auto get = [](const Record& record) {
        const auto* found = find<Path...>(record);
        return found == nullptr ? FieldValue() : value_of(*found);
    };
    const auto set = [](Record& record, const FieldValue& value) {
        const bool absent = std::holds_alternative<std::monostate>(value) && find<Path...>(record) == nullptr;
        return absent || read(value, make<Path...>(record));
    };
    return {name, get, set};
}

// Of a pattern and of each of its answers, then those of its own.
template <class Record>
std::vector<RecordField<Record>> pattern_fields(const std::vector<RecordField<Record>>& own) {
    using R = Record;
    using I = EnergyInterval;
    std::vector<RecordField<Record>> fields{member<R, &R::pattern, &Pattern::cells>("cells"),
                                            member<R, &R::pattern, &Pattern::free_steps>("free_steps"),
                                            member<R, &R::pattern, &Pattern::contact_steps>("contact_steps"),
                                            member<R, &R::gap_sign>("gap_sign"),
                                            member<R, &R::kernel_dimension>("kernel_dimension"),
                                            member<R, &R::verdict>("verdict"),
                                            member<R, &R::kind>("kind"),
                                            member<R, &R::interval, &I::least>("energy_least"),
                                            member<R, &R::interval, &I::greatest>("energy_greatest"),
                                            member<R, &R::interval, &I::bound>("energy_bound"),
                                            member<R, &R::interval, &I::unbounded>("energy_unbounded"),
                                            member<R, &R::interval, &I::least_exact>("energy_least_exact"),
                                            member<R, &R::interval, &I::greatest_exact>("energy_greatest_exact")};
    fields.insert(fields.end(), own.begin(), own.end());
    return fields;
}

}  // namespace

template <>
const std::vector<RecordField<PatternRecord>>& fields_of() {
    using R = PatternRecord;
    static const auto fields = pattern_fields<R>({member<R, &R::proved>("proved"),  //
                                                  member<R, &R::reason>("reason"),  //
                                                  member<R, &R::seconds>("seconds")});
    return fields;
}

template <>
const std::vector<RecordField<OrbitAnswer>>& fields_of() {
    using A = OrbitAnswer;
    using O = Optimality;
    using R = Replay;
    using V = Violations;
    using C = Classification;
    using L = MotionLabel;
    using E = ExactProof;
    static const auto fields =
        pattern_fields<A>({member<A, &A::verdict_proved>("verdict_proved"),
                           member<A, &A::reason>("reason"),
                           member<A, &A::level>("level"),
                           member<A, &A::objective>("objective"),
                           member<A, &A::objective_value>("objective_value"),
                           member<A, &A::objective_difference>("objective_difference"),
                           member<A, &A::method>("method"),
                           member<A, &A::agreement>("agreement"),
                           member<A, &A::energy>("energy"),
                           member<A, &A::optimality, &O::global>("optimum_global"),
                           member<A, &A::optimality, &O::lower_bound>("objective_bound"),
                           member<A, &A::optimality, &O::gap>("objective_gap"),
                           member<A, &A::optimality, &O::kkt_residual>("kkt_residual"),
                           member<A, &A::exact_proof, &E::gap>("certified_gap"),
                           member<A, &A::exact_proof, &E::check_seconds>("check_seconds"),
                           member<A, &A::exact_proof, &E::certificate>("certificate"),
                           member<A, &A::replay, &R::accepted>("replay_accepted"),
                           member<A, &A::replay, &R::same_labels>("replay_same_labels"),
                           member<A, &A::replay, &R::violations, &V::periodicity>("violation_periodicity"),
                           member<A, &A::replay, &R::violations, &V::cond1>("violation_cond1"),
                           member<A, &A::replay, &R::violations, &V::cond2>("violation_cond2"),
                           member<A, &A::replay, &R::violations, &V::cond3>("violation_cond3"),
                           member<A, &A::replay, &R::violations, &V::energy>("violation_energy"),
                           member<A, &A::classification, &C::minimal_period_steps>("minimal_period_steps"),
                           member<A, &A::classification, &C::silent_contact_steps>("silent_contact_steps"),
                           member<A, &A::classification, &C::wall_touches>("wall_touches"),
                           member<A, &A::classification, &C::forceless>("forceless"),
                           member<A, &A::classification, &C::full_support>("full_support"),
                           member<A, &A::classification, &C::tolerance>("classification_tolerance"),
                           member<A, &A::classification, &C::same_motion_as, &L::free_steps>("same_free_steps"),
                           member<A, &A::classification, &C::same_motion_as, &L::contact_steps>("same_contact_steps"),
                           member<A, &A::classification, &C::same_motion_as, &L::shift_steps>("same_shift_steps"),
                           member<A, &A::classification, &C::same_motion_as, &L::reversed>("same_reversed"),
                           member<A, &A::seconds>("seconds")});
    return fields;
}

template <>
const std::vector<RecordField<SolverRun>>& fields_of() {
    using R = SolverRun;
    static const std::vector<RecordField<R>> fields{
        member<R, &R::name>("solver"),           member<R, &R::start>("start"),
        member<R, &R::status>("status"),         member<R, &R::usable>("usable"),
        member<R, &R::objective>("objective"),   member<R, &R::violation>("violation"),
        member<R, &R::iterations>("iterations"), member<R, &R::seconds>("seconds")};
    return fields;
}

ResultRows rows_of(const WorkResult& result) {
    ResultRows rows{result.pattern, result.place, {}, {}, {}};
    if (result.record) rows.record = row_of(*result.record);
    if (result.answer) {
        rows.record = row_of(*result.answer);
        for (const SolverRun& run : result.answer->solvers) rows.runs.push_back(row_of(run));
        if (const auto& orbit = result.answer->orbit) rows.beta.assign(orbit->beta.begin(), orbit->beta.end());
    }
    return rows;
}

WorkResult result_of(const ResultRows& rows, const Bar& bar) {
    WorkResult result{rows.pattern, rows.place, std::nullopt, std::nullopt};
    if (rows.place < 0) {
        result.record = record_of<PatternRecord>(rows.record);
        return result;
    }
    OrbitAnswer& answer = result.answer.emplace(record_of<OrbitAnswer>(rows.record));
    for (const RecordRow& run : rows.runs) answer.solvers.push_back(record_of<SolverRun>(run));
    if (!rows.beta.empty()) {
        answer.orbit = make_orbit(
            bar, exact_kernel(answer.pattern),
            Eigen::Map<const Eigen::VectorXd>(rows.beta.data(), static_cast<Eigen::Index>(rows.beta.size())));
    }
    return result;
}

}  // namespace nsma
