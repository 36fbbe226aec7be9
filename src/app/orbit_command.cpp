#include <fmt/format.h>

#include "command.hpp"
#include "draw.hpp"
#include "standard_streams.hpp"

#include "nsma/orbit/physical_values.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/report/orbit_json.hpp"
#include "report/bar_text.hpp"
#include "report/folder_lock.hpp"
#include "report/orbit_folder.hpp"
#include "report/record_values.hpp"
#include "report/sweep/sweep_charts.hpp"

namespace nsma::app {
namespace {

std::string energy_text(double energy, const Bar& bar) {
    if (bar.gap == 0) return fmt::format("{:.10g} J", energy);
    const std::string ratio = fmt::format("{:.10g} E_g", energy);
    return is_unit_bar(bar) ? ratio : ratio + " (" + si_text(energy * bar.energy_unit(), "J") + ")";
}

std::string_view meaning(PatternKind kind) {
    switch (kind) {
        case PatternKind::contact: return "its orbits press against the wall and leave it";
        case PatternKind::free:
            return "no orbit presses against the wall; a free vibration that grazes it, not a contact motion";
        case PatternKind::stuck: break;
    }
    return "no orbit leaves the wall; a vibration with the end held, not a contact motion";
}

// What presolve took from the conditions before any program was built.
void print_presolve(const Reduction& reduction) {
    const RemovalCounts& removed = reduction.removed;
    fmt::print(
        "presolve      {} unknowns and {} COND1 rows kept; classes removed: {} dead, {} in sign conflict, {} forced to "
        "zero;\n"
        "              rows removed: {} COND2 duplicates, {} COND3 rows (now bounds), COND1: {} silent, {} implied, {} "
        "duplicate, {} dominated\n",
        reduction.variables(), reduction.rows.rows(), removed.dead_classes, removed.sign_conflicts, removed.forced_zero,
        removed.contact_duplicates, removed.force_rows, removed.silent_rows, removed.implied_rows,
        removed.duplicate_rows, removed.dominated_rows);
}

// What an experiment would measure.
void print_measurable(const Orbit& orbit) {
    const PhysicalValues values = physical_values(orbit);
    const Bar& bar = orbit.bar;
    fmt::print("frequency     {} (T = {})\n", si_text(values.frequency, "Hz"), si_text(1.0 / values.frequency, "s"));
    fmt::print("energy        {}", si_text(energy(orbit), "J"));
    if (bar.gap != 0) fmt::print(" = {:.10g} E_g", energy_ratio(orbit));
    if (bar.gap < 0)
        fmt::print("; at rest against the wall E_g, so {} above rest", si_text(energy(orbit) - bar.energy_unit(), "J"));
    fmt::print("\npeak force    {}\nimpact speed  {}\npeak stress   {} at the fixed end\ntip           {} to {}\n",
               si_text(values.peak_force, "N"), si_text(values.impact_speed, "m/s"), si_text(values.peak_stress, "Pa"),
               si_text(values.tip_least, "m"), si_text(bar.gap, "m"));
}

void print_text(const Bar& bar, const OrbitAnswer& answer, const Reduction& reduction, bool verbose) {
    const Pattern& pattern = answer.pattern;
    if (answer.orbit) print_measurable(*answer.orbit);
    if (answer.kind) fmt::print("kind          {}: {}\n", name(*answer.kind), meaning(*answer.kind));
    fmt::print("pattern       r = {}, p = {}, N = {}: m = {}, T/tau = {:.6g}, omega/omega_1 = {:.6g}\n",
               pattern.free_steps, pattern.contact_steps, pattern.cells, answer.kernel_dimension,
               pattern.period_ratio(), pattern.frequency_ratio());
    fmt::print("verdict       {}{}{}{}\n", name(answer.verdict), answer.verdict_proved ? ", proved" : "",
               answer.reason.empty() ? "" : "; ", answer.reason);
    if (answer.interval.least) {
        const std::string greatest = answer.interval.unbounded  ? "unbounded"
                                     : answer.interval.greatest ? energy_text(*answer.interval.greatest, bar)
                                                                : "unknown";
        const auto exactly = [](const std::string& fraction) {
            return fraction.find('/') == std::string::npos ? std::string() : " = " + fraction;
        };
        fmt::print("energies      {}{} to {}{}\n", energy_text(*answer.interval.least, bar),
                   exactly(answer.interval.least_exact), greatest, exactly(answer.interval.greatest_exact));
    }
    if (verbose && answer.kernel_dimension > 0) print_presolve(reduction);
    if (!answer.orbit) return;
    fmt::print("objective     {} = {:.10g} (by {})\n", name(answer.objective), *answer.objective_value, answer.method);
    const auto& violations = answer.replay->violations;
    fmt::print("replay        periodicity {:.1e}, COND1 {:.1e}, COND2 {:.1e}, COND3 {:.1e}, energy {:.1e} (relative)\n",
               violations.periodicity, violations.cond1, violations.cond2, violations.cond3, violations.energy);
    const auto& kind = *answer.classification;
    fmt::print("motion        {}minimal period {} steps, {} silent contact steps, {} touches in flight, {} support\n",
               kind.forceless ? "no force, " : "", kind.minimal_period_steps, kind.silent_contact_steps,
               kind.wall_touches, kind.full_support ? "full" : "partial");
    if (const auto& label = kind.same_motion_as) {
        fmt::print("also          r = {}, p = {}, {} steps later{}\n", label->free_steps, label->contact_steps,
                   label->shift_steps, label->reversed ? ", backward in time" : "");
    }
    if (const auto& optimality = answer.optimality; optimality && optimality->lower_bound) {
        fmt::print("bound         {:.10g}, {}\n", *optimality->lower_bound,
                   optimality->global ? "the best orbit at this level" : fmt::format("gap {:.1e}", optimality->gap));
    }
    std::size_t further = answer.solvers.size();
    for (const char* solver : {"ipopt", "nlopt"}) {
        const SolverRun* run = best_run(answer, solver);
        if (run == nullptr) continue;
        --further;
        fmt::print("{:<13} start {}: {}, {} iterations, {:.1f} ms, objective {}, raw violation {:.1e}\n", run->name,
                   run->start, run->status, run->iterations, 1e3 * run->seconds,
                   run->usable ? fmt::format("{:.10g}", run->objective) : "unusable", run->violation);
    }
    fmt::print(
        "agreement     {}{}{}\n", name(answer.agreement),
        answer.objective_difference ? fmt::format(", relative difference {:.1e}", *answer.objective_difference) : "",
        further > 0 ? fmt::format(", {} further runs", further) : "");
    fmt::print("alpha [m/s]  ");
    const Eigen::VectorXd alpha = amplitudes(*answer.orbit);
    for (const double value : alpha) fmt::print(" {:.6g}", value + 0.0);
    fmt::print("\n");
}

// Charts, curves and JSON of an orbit in a folder of their own.
void write_orbit(const std::filesystem::path& folder, const Scene& scene, const OrbitAnswer& answer, bool list) {
    const FolderLock lock(folder);
    write_orbit_folder(folder, scene, answer);
    const StoredOrbit orbit{answer.level, *answer.energy, *answer.orbit};
    if (list) fmt::print("results are in {}\n", folder.string());
    draw_if_possible(charts_of(scene, orbit, "orbit"), folder, !list);
}

// The exit code of an answer.
int exit_code(const OrbitAnswer& answer) {
    switch (answer.verdict) {
        case Verdict::admissible: break;
        case Verdict::failed:
        case Verdict::undecided: return exit_solver;
        default: return exit_inadmissible;
    }
    switch (answer.agreement) {
        case Agreement::not_needed:
        case Agreement::agree:
        case Agreement::single: return exit_done;
        default: return exit_solver;
    }
}

}  // namespace

int run_orbit(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    arguments.check_energy(scene, "command line: --objective");
    OrbitRequest request;
    request.objective = scene.objective;
    request.level = arguments.level(scene);
    const PatternProblem problem = pattern_problem(arguments.patterns(scene).front(), scene.bar.gap_sign());
    const OrbitAnswer answer = OrbitSolver(arguments.solver).solve(scene.bar, problem, request);
    if (arguments.json) {
        fmt::print("{}\n", orbit_json(answer, scene.bar));
    } else {
        fmt::print("{}\n", derived_text(scene));
        print_text(scene.bar, answer, problem.set.reduction, arguments.verbose);
    }
    if (answer.orbit && !arguments.out.empty()) write_orbit(arguments.out, scene, answer, !arguments.json);
    return exit_code(answer);
}

}  // namespace nsma::app
