#include <cstdio>

#include <fmt/format.h>

#include "commands.hpp"
#include "progress.hpp"

#include "nsma/study/sensitivity/sensitivity.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"

namespace nsma::app {
namespace {

class WatchedRecords final : public SensitivityRecords {
public:
    explicit WatchedRecords(Progress& progress) : progress_(progress) {}
    void progress(long done, long total) override { progress_.show(done, total); }

private:
    Progress& progress_;
};

}  // namespace

int run(const SensitivityArguments& arguments, const std::atomic<bool>& stop) {
    Scene scene = load_scene({arguments.scene_file, std::nullopt, std::nullopt});
    if (arguments.all_kinds) scene.all_kinds = true;
    if (arguments.objective) scene.objective = *arguments.objective;
    SensitivityRequest request;
    request.solver = arguments.solver;
    request.level = arguments.energy;
    if (arguments.free_steps) {
        request.pattern = Pattern{scene.mesh.cells, *arguments.free_steps, *arguments.contact_steps};
        if (scene.bar.gap_sign() == 0 && !arguments.energy) {
            throw InputError(
                "command line: --energy: expected joules (a closed gap has no least-energy orbit), got none");
        }
    }
    const bool extreme = is_extreme(scene.objective);
    if (extreme && request.level) {
        throw InputError(fmt::format("command line: --energy: expected none with objective {}, got {}",
                                     name(scene.objective), *request.level));
    }
    if (extreme && scene.bar.gap_sign() == 0) {
        throw InputError(fmt::format("{}: objective: expected one at a given energy for a closed gap, got {}",
                                     arguments.scene_file, name(scene.objective)));
    }
    open_sensitivity_folder(arguments.out, scene);
    SensitivityRecords records;
    SensitivitySummary summary;
    {
        Progress progress("sensitivity", arguments.quiet);
        WatchedRecords watched(progress);
        summary = sensitivity(scene, request, watched, [&] { return !stop.load(); });
        records = std::move(watched);
    }
    write_sensitivity(arguments.out, scene, records, summary);
    fmt::print("{}results are in {}\n", sensitivity_text("sensitivity.txt", scene, records, summary), arguments.out);
    if (!summary.interrupted) {
        for (const auto& picture : draw_sensitivity(arguments.out, scene, records))
            fmt::print("chart    {}\n", picture.string());
    }
    if (summary.left > 0 && summary.left == summary.admissible) {
        fmt::print(stderr, "nsma: no pattern of the scene is a contact motion; --all-kinds studies the other {}\n",
                   summary.left);
    }
    if (std::fflush(stdout) != 0) throw InputError("stdout: expected room to write, got an error");
    if (summary.interrupted) return exit_interrupted;
    if (summary.failed > 0) return exit_solver;
    return summary.optima > 0 ? exit_done : exit_inadmissible;
}

}  // namespace nsma::app
