#include <algorithm>
#include <chrono>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "command.hpp"
#include "crew.hpp"
#include "progress.hpp"

#include "study/sweep/sweep_queue.hpp"
#include "study/sweep/work_messages.hpp"
#include "report/sweep/sweep_charts.hpp"
#include "report/sweep/sweep_export.hpp"
#include "report/sweep/tables.hpp"

namespace nsma::app {
namespace {

void draw(const std::string& folder, bool list = true) {
    const DrawnCharts charts = draw_sweep(folder);
    for (const auto& picture : charts.pictures) {
        if (list) fmt::print("chart    {}\n", picture.string());
    }
    for (const auto& line : charts.skipped) fmt::print(stderr, "nsma: {}\n", line);
}

// What decides an answer besides scene and software.
std::string options_text(const OrbitSolverOptions& options, bool all_kinds) {
    const auto* solver = std::find_if(solver_choices.begin(), solver_choices.end(),
                                      [&](const auto& choice) { return choice.second == options.solvers; });
    return fmt::format("solver {}, starts {}, tolerance {}, kinds {}", solver->first, options.starts,
                       options.solver.tolerance, all_kinds ? "all" : "contact");
}

// A process that only computes.
void help(Crew& crew, const Scene& scene, const OrbitSolverOptions& options) {
    SweepWorker worker(scene, options);
    while (const auto units = crew.next()) crew.report(packed(worker.run(unpacked_units(*units))));
}

// The number of this process among the workers of a queue; the crew's are 0, 1, ...
constexpr int own_worker = -2;

// Hands out units and takes in results until all is done, stop is asked or nobody is left.
void share(Crew& crew, const Scene& scene, SweepQueue& queue,
           const std::function<void(const std::vector<WorkResult>&)>& keep, const std::atomic<bool>& stop) {
    std::set<int> idle;
    for (int worker = 0; worker < crew.workers(); ++worker) {
        if (crew.present(worker)) idle.insert(worker);
    }
    std::size_t present = idle.size();
    const auto give = [&](int worker) {
        const auto units = stop.load() ? std::vector<WorkUnit>() : queue.next(worker);
        if (units.empty()) return false;
        crew.hand(worker, packed(units));
        idle.erase(worker);
        return true;
    };
    while (present > 0) {
        while (!idle.empty() && give(*idle.begin())) {
        }
        // What is in hand is kept also after stop.
        if (idle.size() == present && (queue.finished() || stop.load())) return;
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
void solve(const Arguments& arguments, Crew& crew, const Scene& scene, SweepStore& store,
           const std::atomic<bool>& stop) {
    SweepQueue queue(scene, arguments.solver,
                     crew.workers() > 0 ? SweepQueue::Order::longest_first : SweepQueue::Order::scene);
    if (arguments.resume) store.for_each([&queue](const WorkResult& result) { queue.done(result); });
    const auto begin = std::chrono::steady_clock::now();
    Progress progress("sweep", arguments.quiet);
    const auto keep = [&](const std::vector<WorkResult>& results) {
        store.put(results);
        for (const WorkResult& result : results) queue.done(result);
        progress.show(queue.done_count(), queue.total_count());
    };
    if (crew.workers() > 0) share(crew, scene, queue, keep, stop);
    // Alone, or with everyone else gone.
    SweepWorker worker(scene, arguments.solver);
    while (!queue.finished() && !stop.load()) {
        const auto units = queue.next(own_worker);
        if (units.empty()) break;
        keep(worker.run(units));
    }
    if (!store.complete()) {
        store.add_seconds(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    if (queue.finished()) store.finish();  // also what a kill left complete but not yet under its name
}

}  // namespace

int run_sweep(const Arguments& arguments, const std::atomic<bool>& stop) {
    const Scene scene = arguments.scene();
    Crew crew;
    if (crew.helper()) {
        help(crew, scene, arguments.solver);
        return exit_done;
    }
    SweepStore store(arguments.out, scene, {version(), options_text(arguments.solver, scene.all_kinds)},
                     arguments.resume ? SweepStore::Mode::resume : SweepStore::Mode::fresh);
    solve(arguments, crew, scene, store, stop);
    const auto [summary, line] = export_sweep(store, arguments.out, arguments.distinct);
    fmt::print("{}{}\n", summary_table(summary), line);
    if (summary.interrupted) return exit_interrupted;
    draw(arguments.out);
    if (summary.failed + summary.failed_patterns + summary.disagreed + summary.one_failed > 0) return exit_solver;
    if (summary.left > 0 && summary.left == summary.admissible) {
        std::fflush(stdout);
        fmt::print(stderr, "nsma: no pattern of the scene is a contact motion; --all-kinds solves the other {}\n",
                   summary.left);
    }
    const bool found = summary.levels > 0 ? summary.solved > 0 : summary.admissible > summary.left;
    return found ? exit_done : exit_inadmissible;
}

int run_export(const Arguments& arguments, const std::atomic<bool>&) {
    const SweepStore store(arguments.input);
    fmt::print("{}\n", export_sweep(store, arguments.input, arguments.distinct).line);
    return exit_done;
}

int run_plot(const Arguments& arguments, const std::atomic<bool>&) {
    draw(arguments.input, !arguments.quiet);
    return exit_done;
}

}  // namespace nsma::app
