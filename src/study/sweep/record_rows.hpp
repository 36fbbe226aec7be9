#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "sweep_work.hpp"

namespace nsma {

/// A record as a row of plain values, for a store or another process: no value, integer,
/// floating point (exactly the double) or text. NaN is written as no value and read back as NaN.
using Value = std::variant<std::monostate, std::int64_t, double, std::string>;
using Row = std::vector<Value>;

/// Names of the values of each row, in order; units as in the records.
[[nodiscard]] std::vector<std::string> pattern_columns();
[[nodiscard]] std::vector<std::string> answer_columns();
[[nodiscard]] std::vector<std::string> run_columns();

/// A result as rows: of the pattern (place -1) or of the answer, its solver runs and, where it
/// has an orbit, its amplitudes. Everything that tables and JSON show comes back from them;
/// of the replay the violations and whether it was accepted.
struct ResultRows {
    Row pattern;
    Row answer;
    std::vector<Row> runs;
    std::vector<double> beta;  ///< nondimensional; empty without an orbit
};
[[nodiscard]] ResultRows rows_of(const WorkResult& result);

/// The inverse, for a bar. Throws std::invalid_argument on rows that do not fit.
[[nodiscard]] PatternRecord pattern_record_of(const Row& row);
[[nodiscard]] OrbitAnswer orbit_answer_of(const ResultRows& rows, const Bar& bar);

}  // namespace nsma
