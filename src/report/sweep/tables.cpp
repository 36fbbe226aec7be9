#include "tables.hpp"

#include <fmt/format.h>

#include "report/bar_text.hpp"
#include "report/csv.hpp"
#include "report/record_values.hpp"

namespace nsma {
namespace {

constexpr const char* scan_columns =
    "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,verdict,"
    "energy_ratio_min,energy_ratio_max,kind";

constexpr const char* patterns_columns =
    "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,verdict,"
    "energy_ratio_min,energy_ratio_max,kind,energy_min_joule,energy_max_joule,energy_unbounded,proved,"
    "energy_min_exact,energy_max_exact,energy_bound,reason,frequency_hz";

constexpr const char* levels_columns =
    "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,period_s,level,verdict,reason,"
    "energy_ratio,energy_joule,objective,objective_value,method,agreement,objective_difference,"
    "violation_periodicity,violation_cond1,violation_cond2,violation_cond3,violation_energy,"
    "minimal_period_steps,silent_contact_steps,wall_touches,full_support,"
    "ipopt_status,ipopt_objective,nlopt_status,nlopt_objective,"
    "verdict_proved,objective_bound,objective_gap,global,kkt_residual,kind,forceless,"
    "same_free_steps,same_contact_steps,same_shift_steps,same_reversed,"
    "frequency_hz,peak_force_n,impact_speed_m_s,peak_stress_pa,tip_min_m,proof";

std::string csv_field(std::monostate) { return {}; }
std::string csv_field(bool value) { return value ? "true" : "false"; }
std::string csv_field(std::int64_t value) { return std::to_string(value); }
std::string csv_field(double value) { return csv_number(value); }
std::string csv_field(const std::string& text) { return csv_text(text); }

// The values of these columns.
std::string csv_row(std::string_view columns, const NamedValues& values) {
    std::string row;
    for (;;) {
        const std::size_t end = columns.find(',');
        row += std::visit([](const auto& value) { return csv_field(value); }, values.at(columns.substr(0, end)));
        if (end == std::string_view::npos) return row;
        row += ',';
        columns.remove_prefix(end + 1);
    }
}

// Whether energies are shown in joules: of a bar with units, and where there is no E_g.
bool in_physical_units(const Bar& bar) { return bar.gap == 0 || !is_unit_bar(bar); }

}  // namespace

std::string scan_csv_header() { return scan_columns; }

std::string scan_csv_row(const Bar& bar, const PatternRecord& record) {
    return csv_row(scan_columns, named_values(bar, record));
}

std::string scan_table_header(const Bar& bar) {
    const bool joules = in_physical_units(bar);
    return fmt::format("{:>8} {:>8} {:>8} {:>5} {:>10} {:>10}{}  {:<12} {:<8} {:>12} {:>12}", "free r", "contact p",
                       "period", "m", "T/tau", "w/w1", is_unit_bar(bar) ? "" : fmt::format(" {:>10}", "f [Hz]"),
                       "verdict", "kind", joules ? "E_min [J]" : "E_min/E_g", joules ? "E_max [J]" : "E_max/E_g");
}

std::string scan_table_row(const Bar& bar, const PatternRecord& record) {
    const Pattern& pattern = record.pattern;
    const auto energy = [&](const std::optional<double>& value) {
        if (!value) return std::string("-");
        return fmt::format("{:.6g}", in_physical_units(bar) ? *value * bar.energy_unit() : *value);
    };
    const double period = pattern.period_ratio() * bar.travel_time();
    return fmt::format("{:>8} {:>9} {:>8} {:>5} {:>10.6g} {:>10.6g}{}  {:<12} {:<8} {:>12} {:>12}", pattern.free_steps,
                       pattern.contact_steps, pattern.period_steps(), record.kernel_dimension, pattern.period_ratio(),
                       pattern.frequency_ratio(), is_unit_bar(bar) ? "" : fmt::format(" {:>10.6g}", 1.0 / period),
                       name(record.verdict), record.kind ? name(*record.kind) : "-", energy(record.interval.least),
                       record.interval.unbounded ? "inf" : energy(record.interval.greatest));
}

std::string patterns_csv_header() { return patterns_columns; }

std::string patterns_csv_row(const Bar& bar, const PatternRecord& record) {
    return csv_row(patterns_columns, named_values(bar, record));
}

std::string levels_csv_header() { return levels_columns; }

std::string levels_csv_row(const Bar& bar, const OrbitAnswer& answer) {
    return csv_row(levels_columns, named_values(bar, answer));
}

std::string timings_csv_header() { return "free_steps,contact_steps,level,what,start,status,iterations,seconds"; }

std::vector<std::string> timings_csv_rows(const PatternRecord& record) {
    return {fmt::format("{},{},,pattern,,{},,{}", record.pattern.free_steps, record.pattern.contact_steps,
                        name(record.verdict), csv_number(record.seconds))};
}

std::vector<std::string> timings_csv_rows(const OrbitAnswer& answer) {
    const std::string start =
        fmt::format("{},{},{}", answer.pattern.free_steps, answer.pattern.contact_steps, csv_number(answer.level));
    std::vector<std::string> rows{
        fmt::format("{},answer,,{},,{}", start, name(answer.verdict), csv_number(answer.seconds))};
    if (const auto& proof = answer.exact_proof)
        rows.push_back(fmt::format("{},check,,certified,,{}", start, csv_number(proof->check_seconds)));
    for (const SolverRun& run : answer.solvers) {
        rows.push_back(fmt::format("{},{},{},{},{},{}", start, csv_text(run.name), run.start, csv_text(run.status),
                                   run.iterations, csv_number(run.seconds)));
    }
    return rows;
}

std::string curves_csv_header() { return "free_steps,contact_steps,level,t_s,x_m,force_n"; }

std::string curves_csv_rows(const Orbit& orbit, std::optional<double> level) {
    const Pattern& pattern = orbit.kernel.pattern;
    const std::string key = fmt::format("{},{},{}", pattern.free_steps, pattern.contact_steps, csv_number(level));
    const Eigen::VectorXd tip = tip_displacement(orbit);
    const Eigen::VectorXd force = contact_force(orbit);
    const double step = orbit.mesh().time_step(orbit.bar);
    std::string rows;
    for (Eigen::Index n = 0; n < tip.size(); ++n) {
        rows += fmt::format("{},{},{},{}\n", key, csv_number(static_cast<double>(n) * step), csv_number(tip[n]),
                            csv_number(force[n % force.size()]));
    }
    return rows;
}

std::string summary_table(const SweepSummary& summary) {
    std::string table = summary.interrupted ? "interrupted: what was done until then\n" : "";
    const auto row = [&table](const char* what, const std::string& value) {
        table += fmt::format("{:<38}{:>10}\n", what, value);
    };
    const auto count = [&row](const char* what, int value) { row(what, fmt::format("{}", value)); };
    count("patterns visited", summary.patterns);
    count("  trivial (no free amplitude)", summary.trivial);
    count("  inadmissible", summary.inadmissible);
    count("  admissible", summary.admissible);
    const char* const meaning[] = {"    contact: press and leave the wall", "    free: graze it without force",
                                   "    stuck: never leave it"};
    for (std::size_t kind = 0; kind < summary.kinds.size(); ++kind) count(meaning[kind], summary.kinds[kind]);
    count("    left, being no contact motion", summary.left);
    count("  failed", summary.failed_patterns);
    count("  without an exact proof", summary.unproved);
    count("  admissible, greatest energy open", summary.open_bounds);
    count("energy levels asked", summary.levels);
    count("  solved", summary.solved);
    count("    proved the best at their level", summary.global);
    if (summary.certificates > 0) count("      of them exactly, by certificates", summary.proved_exactly);
    count("    not proved the best", summary.solved - summary.global);
    count("    a motion solved above once more", summary.copies);
    count("    closed form, or proved alone", summary.closed_form);
    count("    solvers agree", summary.agreed);
    count("    solvers at different optima", summary.disagreed);
    count("    one solver failed", summary.one_failed);
    count("  below the pattern's least energy", summary.below);
    count("  above its greatest energy", summary.above);
    count("  undecided", summary.undecided);
    count("  failed", summary.failed);
    row("largest gap to the proved optimum", fmt::format("{:.2e}", summary.worst_gap));
    row("worst replayed violation", fmt::format("{:.2e}", summary.worst_violation));
    if (summary.certificates > 0) {
        count("certificates of orbits", summary.certificates);
        row("  size [kB]", fmt::format("{:.1f}", 1e-3 * static_cast<double>(summary.certificate_bytes)));
        row("  time to check them [s]", fmt::format("{:.3f}", summary.check_seconds));
    }
    row("time [s]", fmt::format("{:.2f}", summary.seconds));
    return table;
}

}  // namespace nsma
