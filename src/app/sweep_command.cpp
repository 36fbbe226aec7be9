#include <fmt/format.h>

#include "commands.hpp"
#include "progress.hpp"

#include "nsma/report/charts.hpp"
#include "nsma/report/scene_file.hpp"
#include "nsma/report/sweep_folder.hpp"
#include "nsma/report/tables.hpp"
#include "nsma/study/sweep.hpp"

namespace nsma::app {
namespace {

// The folder's sink, with progress for the user.
class WatchedSink final : public SweepSink {
public:
    WatchedSink(SweepFolder& folder, Progress& progress) : folder_(folder), progress_(progress) {}
    void pattern(const PatternRecord& record) override { folder_.pattern(record); }
    void answer(const OrbitAnswer& answer) override { folder_.answer(answer); }
    void progress(long done, long total) override { progress_.show(done, total); }

private:
    SweepFolder& folder_;
    Progress& progress_;
};

void draw(const std::string& folder) {
    const DrawnCharts charts = draw_charts(folder);
    for (const auto& picture : charts.pictures) fmt::print("chart    {}\n", picture.string());
    for (const auto& line : charts.skipped) fmt::print(stderr, "nsma: {}\n", line);
}

}  // namespace

int run(const SweepArguments& arguments, const std::atomic<bool>& stop) {
    const Scene scene = load_scene({arguments.scene_file, std::nullopt, std::nullopt});
    SweepFolder folder(arguments.out, scene);
    SweepSummary summary;
    {
        Progress progress("sweep", arguments.quiet);
        WatchedSink sink(folder, progress);
        summary = sweep(scene, arguments.solver, sink, [&] { return !stop.load(); });
    }
    const std::string line = folder.finish(summary);
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

int run(const PlotArguments& arguments, const std::atomic<bool>&) {
    draw(arguments.folder);
    return exit_done;
}

int run(const TextArguments& arguments, const std::atomic<bool>&) {
    fmt::print("{}", arguments.text);
    return exit_done;
}

}  // namespace nsma::app
