#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "sweep_work.hpp"

namespace nsma {

/// No value, truth value, integer, floating point (exactly the double) or text. NaN is no value.
using FieldValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;
using RecordRow = std::vector<FieldValue>;

/// One field of a record: its name, and its value out of a record and into one.
template <class Record>
struct RecordField {
    const char* name;
    FieldValue (*get)(const Record&);
    bool (*set)(Record&, const FieldValue&);  ///< false: a value of another kind
};

/// All fields of a record, in order, units as in the record: what the store, the messages between processes, the
/// tables and JSON are made from. Those of an answer are without its solver runs and its orbit.
template <class Record>
[[nodiscard]] const std::vector<RecordField<Record>>& fields_of();
template <>
const std::vector<RecordField<PatternRecord>>& fields_of();
template <>
const std::vector<RecordField<OrbitAnswer>>& fields_of();
template <>
const std::vector<RecordField<SolverRun>>& fields_of();

template <class Record>
[[nodiscard]] RecordRow row_of(const Record& record) {
    RecordRow row;
    for (const auto& field : fields_of<Record>()) row.push_back(field.get(record));
    return row;
}

/// The inverse. Throws std::invalid_argument on a row that does not fit.
template <class Record>
[[nodiscard]] Record record_of(const RecordRow& row) {
    const auto& fields = fields_of<Record>();
    if (row.size() != fields.size()) {
        throw std::invalid_argument("row: expected " + std::to_string(fields.size()) + " values, got " +
                                    std::to_string(row.size()));
    }
    Record record;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (fields[i].set(record, row[i])) continue;
        throw std::invalid_argument(std::string(fields[i].name) + ": expected a value of its kind, got another");
    }
    return record;
}

/// A result as rows. Everything that tables and JSON show comes back from them; of the replay the violations and
/// whether it was accepted.
struct ResultRows {
    long pattern = 0;
    int place = -1;
    RecordRow record;  ///< of the pattern (place -1) or of the answer
    std::vector<RecordRow> runs;
    std::vector<double> beta;  ///< nondimensional; empty without an orbit
};
[[nodiscard]] ResultRows rows_of(const WorkResult& result);
/// The inverse, for a bar. Throws std::invalid_argument on rows that do not fit.
[[nodiscard]] WorkResult result_of(const ResultRows& rows, const Bar& bar);

}  // namespace nsma
