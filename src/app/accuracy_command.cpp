#include <fmt/format.h>

#include "commands.hpp"
#include "progress.hpp"

#include "study/accuracy/accuracy.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/accuracy/accuracy_folder.hpp"

namespace nsma::app {
namespace {

// The folder's sink, with progress for the user.
class WatchedSink final : public AccuracySink {
public:
    WatchedSink(AccuracyFolder& folder, Progress& progress) : folder_(folder), progress_(progress) {}
    void program(const ProgramRecord& record) override { folder_.program(record); }
    void kernel(const KernelRecord& record) override { folder_.kernel(record); }
    void march(const MarchRecord& record) override { folder_.march(record); }
    void drift(const DriftRecord& record) override { folder_.drift(record); }
    void stability(const StabilityRecord& record) override { folder_.stability(record); }
    void tolerance(const ToleranceRecord& record) override { folder_.tolerance(record); }
    void progress(long done, long total) override { progress_.show(done, total); }

private:
    AccuracyFolder& folder_;
    Progress& progress_;
};

}  // namespace

int run(const AccuracyArguments& arguments, const std::atomic<bool>& stop) {
    const Scene scene = load_scene({arguments.scene_file, std::nullopt, std::nullopt});
    if (scene.bar.gap_sign() == 0) {
        throw InputError(
            fmt::format("{}: gap: expected one that is not zero: a closed gap has no energy interval to study, got 0",
                        arguments.scene_file));
    }
    if (is_extreme(scene.objective)) {
        throw InputError(fmt::format("{}: objective: expected one at a given energy, got {}", arguments.scene_file,
                                     name(scene.objective)));
    }
    AccuracyFolder folder(arguments.out, scene);
    bool whole = false;
    {
        Progress progress("accuracy", arguments.quiet);
        WatchedSink sink(folder, progress);
        whole = accuracy(scene, {arguments.quick}, sink, [&] { return !stop.load(); });
    }
    if (!whole) {
        fmt::print("interrupted: the rows so far are in {} as .part files\n", arguments.out);
        return exit_interrupted;
    }
    folder.finish();
    const std::filesystem::path charts = std::filesystem::path(arguments.out) / "charts";
    for (const Chart& chart : accuracy_charts(folder.results())) {
        draw_chart(chart, charts);
        fmt::print("chart    {}\n", (charts / (chart.name + ".png")).string());
    }
    fmt::print("results are in {}\n", arguments.out);
    if (std::fflush(stdout) != 0) throw InputError("stdout: expected room to write, got an error");
    return exit_done;
}

}  // namespace nsma::app
