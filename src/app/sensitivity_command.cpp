#include <algorithm>

#include <fmt/format.h>

#include "command.hpp"
#include "draw.hpp"
#include "progress.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "nsma/study/sensitivity/sensitivity.hpp"
#include "report/bar_text.hpp"
#include "report/folder_lock.hpp"
#include "report/sensitivity/sensitivity_charts.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"

namespace nsma::app {
int run_sensitivity(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    arguments.check_energy(scene, arguments.input + ": objective");
    SensitivityRequest request;
    request.solver = arguments.solver;
    request.level = arguments.level(scene);
    const auto patterns = arguments.patterns(scene);
    if (arguments.free_steps > 0) request.pattern = patterns.front();
    const FolderLock lock(arguments.out);
    open_sensitivity_folder(arguments.out, scene);
    Progress progress("sensitivity", arguments.quiet);
    const auto show = [&](long done, long total) {
        progress.show(static_cast<double>(done), static_cast<double>(total),
                      patterns[static_cast<std::size_t>(std::min(done, total - 1))]);
    };
    const SensitivityRecords records = sensitivity(
        scene, request, [] { return !stop_requested(); }, show);
    const SensitivitySummary& summary = records.summary;
    progress.clear();
    write_sensitivity(arguments.out, scene, records);
    fmt::print("{}\n{}results are in {}\n", derived_text(scene), sensitivity_text("sensitivity.txt", scene, records),
               arguments.out);
    if (!summary.interrupted) draw_if_possible(sensitivity_charts(scene, records), arguments.out);
    if (summary.left > 0 && summary.left == summary.admissible) {
        say("no pattern of the scene is a contact motion; --all-kinds studies the other {}", summary.left);
    }
    if (summary.interrupted) return exit_interrupted;
    if (summary.failed > 0) return exit_solver;
    return summary.optima > 0 ? exit_done : exit_inadmissible;
}

}  // namespace nsma::app
