#include <chrono>

#include <fmt/format.h>

#include "commands.hpp"
#include "progress.hpp"

#include "nsma/report/charts.hpp"
#include "nsma/report/scene_file.hpp"
#include "nsma/report/sweep_store.hpp"
#include "nsma/report/tables.hpp"
#include "nsma/study/sweep_work.hpp"

namespace nsma::app {
namespace {

void draw(const std::string& folder) {
    const DrawnCharts charts = draw_charts(folder);
    for (const auto& picture : charts.pictures) fmt::print("chart    {}\n", picture.string());
    for (const auto& line : charts.skipped) fmt::print(stderr, "nsma: {}\n", line);
}

// What decides an answer besides scene and software.
std::string options_text(const OrbitSolverOptions& options) {
    const char* solvers = options.solvers == SolverChoice::both    ? "both"
                          : options.solvers == SolverChoice::ipopt ? "ipopt"
                                                                   : "nlopt";
    return fmt::format("solver {}, starts {}, bound nodes {}, tolerance {}", solvers, options.starts,
                       options.bound_nodes, options.solver.tolerance);
}

}  // namespace

int run(const SweepArguments& arguments, const std::atomic<bool>& stop) {
    const Scene scene = load_scene({arguments.scene_file, std::nullopt, std::nullopt});
    SweepStore store(arguments.out, scene, {version(), options_text(arguments.solver)},
                     arguments.resume ? SweepStore::Mode::resume : SweepStore::Mode::fresh);
    SweepQueue queue(scene, SweepQueue::Order::scene);
    if (arguments.resume) store.for_each([&queue](const WorkResult& result) { queue.done(result); });
    const auto begin = std::chrono::steady_clock::now();
    {
        Progress progress("sweep", arguments.quiet);
        SweepWorker worker(scene, arguments.solver);
        while (!queue.finished() && !stop.load()) {
            const WorkResult result = worker.run(*queue.next(0));
            store.put(result);
            queue.done(result);
            progress.show(queue.done_count(), queue.total_count());
        }
    }
    if (!store.complete()) {
        store.add_seconds(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        if (queue.finished()) store.finish();
    }
    const auto [summary, line] = export_sweep(store, arguments.out);
    fmt::print("{}{}\n", summary_table(summary), line);
    if (summary.interrupted) {
        std::fflush(stdout);
        return exit_interrupted;
    }
    draw(arguments.out);
    if (std::fflush(stdout) != 0) throw InputError("stdout: expected room to write, got an error");
    if (summary.failed + summary.failed_patterns + summary.disagreed + summary.one_failed > 0) return exit_solver;
    const bool found = summary.levels > 0 ? summary.solved > 0 : summary.admissible > 0;
    return found ? exit_done : exit_inadmissible;
}

int run(const ExportArguments& arguments, const std::atomic<bool>&) {
    const SweepStore store(arguments.folder);
    fmt::print("{}\n", export_sweep(store, arguments.folder).line);
    return exit_done;
}

int run(const PlotArguments& arguments, const std::atomic<bool>&) {
    draw(arguments.folder);
    return exit_done;
}

int run(const TextArguments& arguments, const std::atomic<bool>&) {
    fmt::print("{}", arguments.text);
    return exit_done;
}

}  // namespace nsma::app
