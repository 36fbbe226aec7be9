#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nsma/study/records.hpp"

namespace nsma {

/// Lines of the CSV and text tables, without their line end. Numbers are the shortest decimals
/// that read back to the same double; a field is empty where there is no value. Units and
/// columns: data/README.md.

/// Columns of `nsma scan --csv`, and the row of one pattern. Energy ratios are E/E_g, empty for
/// a closed gap; energy_ratio_max is empty when unbounded or unknown.
[[nodiscard]] std::string scan_csv_header();
[[nodiscard]] std::string scan_csv_row(const Bar& bar, const PatternRecord& record);

/// The same for the terminal: aligned columns, "inf" for unbounded, "-" for no value; of a bar with units the frequency
/// too, and energies in joules, as those of a closed gap are.
[[nodiscard]] std::string scan_table_header(const Bar& bar);
[[nodiscard]] std::string scan_table_row(const Bar& bar, const PatternRecord& record);

/// Columns of a sweep's patterns.csv: those of the scan, then energy_min_joule,
/// energy_max_joule, energy_unbounded and reason.
[[nodiscard]] std::string patterns_csv_header();
[[nodiscard]] std::string patterns_csv_row(const Bar& bar, const PatternRecord& record);

/// Columns of a sweep's levels.csv, one row an answer; no times, so that runs can be compared.
[[nodiscard]] std::string levels_csv_header();
[[nodiscard]] std::string levels_csv_row(const Bar& bar, const OrbitAnswer& answer);

/// Columns of a sweep's timings.csv: seconds of every pattern, answer and solver run.
[[nodiscard]] std::string timings_csv_header();
[[nodiscard]] std::vector<std::string> timings_csv_rows(const PatternRecord& record);
[[nodiscard]] std::vector<std::string> timings_csv_rows(const OrbitAnswer& answer);

/// Columns of curves.csv: motion and force of an orbit over one period, n_T + 1 rows; a force is that of the step that
/// begins at its time, the last row begins the next period.
[[nodiscard]] std::string curves_csv_header();
[[nodiscard]] std::string curves_csv_rows(const Orbit& orbit, std::optional<double> level);

/// The counts of a sweep as an aligned table; ends with a line end.
[[nodiscard]] std::string summary_table(const SweepSummary& summary);

}  // namespace nsma
