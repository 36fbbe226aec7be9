#include <algorithm>
#include <chrono>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "command.hpp"
#include "crew.hpp"
#include "draw.hpp"
#include "progress.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "study/sweep/sweep_queue.hpp"
#include "study/sweep/work_messages.hpp"
#include "report/bar_text.hpp"
#include "report/certificate_file.hpp"
#include "report/folder_lock.hpp"
#include "report/page/report_page.hpp"
#include "report/sweep/sweep_charts.hpp"
#include "report/sweep/sweep_export.hpp"
#include "report/sweep/sweep_folder.hpp"
#include "report/sweep/tables.hpp"

namespace nsma::app {
namespace {

// What decides an answer besides scene and software.
std::string options_text(const OrbitSolverOptions& options, bool all_kinds, bool certify) {
    const auto* solver = std::find_if(solver_choices.begin(), solver_choices.end(),
                                      [&](const auto& choice) { return choice.second == options.solvers; });
    return fmt::format("solver {}, starts {}, tolerance {}, kinds {}{}", solver->first, options.starts,
                       options.solver.tolerance, all_kinds ? "all" : "contact", certify ? ", certified" : "");
}

SweepWorker make_worker(const Scene& scene, const Arguments& arguments) {
    return {scene, arguments.solver, arguments.certify ? certificate_json : SweepWorker::CertificateText()};
}

// A process that only computes. Of a scene that nobody can read the process that leads tells.
int help(Crew& crew, const Arguments& arguments) {
    std::optional<Scene> scene;
    std::string refusal;
    try {
        scene = arguments.scene();
    } catch (const InputError& error) {
        refusal = error.what();
    }
    std::optional<SweepWorker> worker;
    while (const auto units = crew.next()) {
        if (!scene) throw InputError(refusal);
        if (!worker) worker.emplace(make_worker(*scene, arguments));
        try {
            crew.report(packed(worker->run(unpacked_units(*units))));
        } catch (const Interrupted&) {
            crew.leave();
        }
    }
    return scene ? exit_done : exit_input;
}

// The number of this process among the workers of a queue; the crew's are 0, 1, ...
constexpr int own_worker = -2;

// Hands out units and takes in results until all is done, stop is asked or nobody is left.
void share(Crew& crew, const Scene& scene, SweepQueue& queue,
           const std::function<void(const std::vector<WorkResult>&)>& keep) {
    std::set<int> idle;
    for (int worker = 0; worker < crew.workers(); ++worker) {
        if (crew.present(worker)) idle.insert(worker);
    }
    std::size_t present = idle.size();
    const auto give = [&](int worker) {
        const auto units = stop_requested() ? std::vector<WorkUnit>() : queue.next(worker);
        if (units.empty()) return false;
        crew.hand(worker, packed(units));
        idle.erase(worker);
        return true;
    };
    while (present > 0) {
        while (!idle.empty() && give(*idle.begin())) {
        }
        // After a stop what the others have in hand is kept, where they do not stop as well.
        if (idle.size() == present && (queue.finished() || stop_requested())) return;
        const auto message = crew.wait();
        if (!message) continue;
        if (message->lost) {
            queue.lost(message->worker);
            idle.erase(message->worker);
            --present;
            continue;
        }
        keep(unpacked_results(message->bytes, scene.bar));
        idle.insert(message->worker);
        (void)give(message->worker);  // it has its pattern at hand
    }
}

// Everything that is not yet in the store, until stop is asked.
void solve(const Arguments& arguments, Crew& crew, const Scene& scene, SweepStore& store) {
    SweepQueue queue(scene, arguments.solver,
                     crew.workers() > 0 ? SweepQueue::Order::longest_first : SweepQueue::Order::scene);
    if (arguments.resume) store.for_each([&queue](const WorkResult& result) { queue.done(result); });
    const auto begin = std::chrono::steady_clock::now();
    Progress progress("sweep", arguments.quiet, static_cast<double>(queue.work_done()));
    const auto keep = [&](const std::vector<WorkResult>& results) {
        store.put(results);
        for (const WorkResult& result : results) queue.done(result);
        const WorkResult& last = results.back();
        progress.show(static_cast<double>(queue.work_done()), static_cast<double>(queue.work_total()),
                      last.record ? last.record->pattern : last.answer->pattern);
    };
    if (crew.workers() > 0) share(crew, scene, queue, keep);
    // Alone, or with everyone else gone.
    SweepWorker worker = make_worker(scene, arguments);
    try {
        while (!queue.finished()) {
            stop_point();
            const auto units = queue.next(own_worker);
            if (units.empty()) break;
            keep(worker.run(units));
        }
    } catch (const Interrupted&) {  // the store says what is left
    }
    if (!store.complete()) {
        store.add_seconds(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    if (queue.finished()) store.finish();  // also what a kill left complete but not yet under its name
}

// An interval of energies in both units.
std::string energies_text(const std::array<double, 2>& span, const Bar& bar) {
    const double unit = bar.energy_unit();
    const std::string joules = si_text(span[0] * unit, "J") + " to " + si_text(span[1] * unit, "J");
    return bar.gap == 0 ? joules : fmt::format("{:.6g} to {:.6g} E_g ({})", span[0], span[1], joules);
}

// A study in the same folder that cannot be read takes nothing from the sweep.
void write_report(const std::filesystem::path& folder) {
    std::string page;
    try {
        page = report_page(folder, version());
    } catch (const InputError& error) {
        return say("no report: {}; the tables are complete without it", error.what());
    }
    write_whole(folder / report_name, page);
    fmt::print("report   {}\n", (folder / report_name).string());
}

}  // namespace

int run_sweep(const Arguments& arguments) {
    Crew crew;
    if (crew.helper()) return help(crew, arguments);
    const Scene scene = arguments.scene();
    const FolderLock lock(arguments.out);
    const std::filesystem::path part = std::filesystem::path(arguments.out) / store_part_name;
    if (std::error_code code; !arguments.resume && !arguments.fresh && std::filesystem::exists(part, code)) {
        throw InputError(
            part.string() +
            ": is an interrupted sweep: expected --resume to go on with it or --fresh to begin anew, got none");
    }
    SweepStore store(arguments.out, scene,
                     {version(), options_text(arguments.solver, scene.all_kinds, arguments.certify)},
                     arguments.resume ? SweepStore::Mode::resume : SweepStore::Mode::fresh);
    solve(arguments, crew, scene, store);
    const auto [summary, line, span, spent] = export_sweep(store, arguments.out, arguments.distinct);
    if (!summary.interrupted) export_curves(store, arguments.out, false);
    fmt::print("{}\n{}{}\n", derived_text(scene), summary_table(summary), line);
    if (const std::string text = open_time_text(spent, arguments.solver.starts); !text.empty())
        fmt::print("{}\n", text);
    if (span && summary.levels > 0 && summary.solved == 0)
        fmt::print("no level was solved: the orbits of these patterns have {}\n", energies_text(*span, scene.bar));
    if (summary.interrupted) return exit_interrupted;
    draw_if_possible(sweep_charts(read_sweep_folder(arguments.out)), arguments.out);
    write_report(arguments.out);
    if (summary.failed + summary.failed_patterns + summary.disagreed + summary.one_failed > 0) return exit_solver;
    if (summary.left > 0 && summary.left == summary.admissible) {
        say("no pattern of the scene is a contact motion; --all-kinds solves the other {}", summary.left);
    }
    const bool found = summary.levels > 0 ? summary.solved > 0 : summary.admissible > summary.left;
    return found ? exit_done : exit_inadmissible;
}

}  // namespace nsma::app
