#include "tables.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/csv.hpp"

namespace nsma {
namespace {

constexpr const char* scan_columns =
    "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,verdict,"
    "energy_ratio_min,energy_ratio_max,kind";

/// A value that is a ratio E/E_g, hence absent when the gap sets no scale.
std::optional<double> ratio(const Bar& bar, const std::optional<double>& value) {
    return bar.gap_sign() == 0 ? std::nullopt : value;
}

std::optional<double> joule(const Bar& bar, const std::optional<double>& value) {
    if (!value) return std::nullopt;
    return *value * bar.energy_unit();
}

std::optional<double> greatest(const EnergyInterval& interval) {
    return interval.unbounded ? std::nullopt : interval.greatest;
}

std::string pattern_fields(const Bar& bar, const Pattern& pattern, int dimension) {
    return fmt::format("{},{},{},{},{},{},{}", pattern.cells, csv_number(bar.gap), pattern.free_steps,
                       pattern.contact_steps, pattern.period_steps(), dimension, csv_number(pattern.frequency_ratio()));
}

std::string_view kind_text(const std::optional<PatternKind>& kind) { return kind ? name(*kind) : std::string_view(); }

std::string terminal_number(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : std::string("-");
}

}  // namespace

std::string scan_csv_header() { return scan_columns; }

std::string scan_csv_row(const Bar& bar, const PatternRecord& record) {
    return fmt::format("{},{},{},{},{}", pattern_fields(bar, record.pattern, record.kernel_dimension),
                       name(record.verdict), csv_number(ratio(bar, record.interval.least)),
                       csv_number(ratio(bar, greatest(record.interval))), kind_text(record.kind));
}

std::string scan_table(const Bar& bar, const std::vector<PatternRecord>& records) {
    const bool closed = bar.gap_sign() == 0;
    std::string table = fmt::format("{:>8} {:>8} {:>8} {:>5} {:>10} {:>10}  {:<12} {:<8} {:>12} {:>12}\n", "free r",
                                    "contact p", "period", "m", "T/tau", "w/w1", "verdict", "kind",
                                    closed ? "E_min [J]" : "E_min/E_g", closed ? "E_max [J]" : "E_max/E_g");
    for (const PatternRecord& record : records) {
        const Pattern& pattern = record.pattern;
        table += fmt::format("{:>8} {:>9} {:>8} {:>5} {:>10.6g} {:>10.6g}  {:<12} {:<8} {:>12} {:>12}\n",
                             pattern.free_steps, pattern.contact_steps, pattern.period_steps(), record.kernel_dimension,
                             pattern.period_ratio(), pattern.frequency_ratio(), name(record.verdict),
                             record.kind ? name(*record.kind) : "-", terminal_number(record.interval.least),
                             record.interval.unbounded ? "inf" : terminal_number(record.interval.greatest));
    }
    return table;
}

std::string patterns_csv_header() {
    return std::string(scan_columns) +
           ",energy_min_joule,energy_max_joule,energy_unbounded,proved,"
           "energy_min_exact,energy_max_exact,energy_bound,reason";
}

std::string patterns_csv_row(const Bar& bar, const PatternRecord& record) {
    const EnergyInterval& interval = record.interval;
    return fmt::format("{},{},{},{},{},{},{},{},{}", scan_csv_row(bar, record), csv_number(joule(bar, interval.least)),
                       csv_number(joule(bar, greatest(interval))), interval.unbounded, record.proved,
                       interval.least_exact, interval.greatest_exact, csv_number(interval.bound),
                       csv_text(record.reason));
}

std::string levels_csv_header() {
    return "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,"
           "period_s,level,"
           "verdict,reason,energy_ratio,energy_joule,objective,objective_value,method,agreement,"
           "objective_difference,violation_periodicity,violation_cond1,violation_cond2,violation_"
           "cond3,"
           "violation_energy,minimal_period_steps,silent_contact_steps,wall_touches,full_support,"
           "ipopt_status,"
           "ipopt_objective,nlopt_status,nlopt_objective,verdict_proved,objective_bound,objective_gap,"
           "global,kkt_residual,kind,forceless,same_free_steps,same_contact_steps,same_shift_steps,same_reversed";
}

std::string levels_csv_row(const Bar& bar, const OrbitAnswer& answer) {
    const double period = answer.pattern.period_steps() * Mesh{answer.pattern.cells}.time_step(bar);
    std::string row = pattern_fields(bar, answer.pattern, answer.kernel_dimension);
    const auto add = [&row](const std::string& field) { row += "," + field; };
    add(csv_number(period));
    add(csv_number(answer.level));
    add(std::string(name(answer.verdict)));
    add(csv_text(answer.reason));
    add(csv_number(ratio(bar, answer.energy)));
    add(csv_number(joule(bar, answer.energy)));
    add(std::string(name(answer.objective)));
    add(csv_number(answer.objective_value));
    add(csv_text(answer.method));
    add(std::string(name(answer.agreement)));
    add(csv_number(answer.objective_difference));
    if (answer.replay) {
        const Violations& violations = answer.replay->violations;
        for (const double value :
             {violations.periodicity, violations.cond1, violations.cond2, violations.cond3, violations.energy}) {
            add(csv_number(value));
        }
    } else {
        row += ",,,,,";
    }
    if (answer.classification) {
        const Classification& kind = *answer.classification;
        add(fmt::format("{},{},{},{}", kind.minimal_period_steps, kind.silent_contact_steps, kind.wall_touches,
                        kind.full_support));
    } else {
        row += ",,,,";
    }
    for (const char* solver : {"ipopt", "nlopt"}) {
        const SolverRun* run = best_run(answer, solver);
        add(run == nullptr ? std::string() : csv_text(run->status));
        add(run == nullptr || !run->usable ? std::string() : csv_number(run->objective));
    }
    add(fmt::format("{}", answer.verdict_proved));
    if (const auto& optimality = answer.optimality) {
        const bool bounded = optimality->lower_bound.has_value();
        add(csv_number(optimality->lower_bound));
        add(bounded ? csv_number(optimality->gap) : std::string());
        add(fmt::format("{}", optimality->global));
        add(csv_number(optimality->kkt_residual));
    } else {
        row += ",,,,";
    }
    add(std::string(kind_text(answer.kind)));
    add(answer.classification ? fmt::format("{}", answer.classification->forceless) : std::string());
    if (answer.classification && answer.classification->same_motion_as) {
        const MotionLabel& label = *answer.classification->same_motion_as;
        add(fmt::format("{},{},{},{}", label.free_steps, label.contact_steps, label.shift_steps, label.reversed));
    } else {
        row += ",,,,";
    }
    return row;
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
    for (const SolverRun& run : answer.solvers) {
        rows.push_back(fmt::format("{},{},{},{},{},{}", start, csv_text(run.name), run.start, csv_text(run.status),
                                   run.iterations, csv_number(run.seconds)));
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
    row("time [s]", fmt::format("{:.2f}", summary.seconds));
    return table;
}

const SolverRun* best_run(const OrbitAnswer& answer, std::string_view solver) {
    const auto run = std::find_if(answer.solvers.begin(), answer.solvers.end(), [solver](const SolverRun& candidate) {
        return std::string_view(candidate.name).substr(0, solver.size()) == solver;
    });
    return run == answer.solvers.end() ? nullptr : &*run;
}

}  // namespace nsma
