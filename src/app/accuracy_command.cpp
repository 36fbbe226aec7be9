#include <fmt/format.h>

#include "command.hpp"
#include "draw.hpp"
#include "progress.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "study/accuracy/accuracy.hpp"
#include "nsma/report/input_error.hpp"
#include "report/accuracy/accuracy_folder.hpp"
#include "report/bar_text.hpp"
#include "report/folder_lock.hpp"

namespace nsma::app {

int run_accuracy(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    if (scene.bar.gap_sign() == 0) {
        throw InputError(arguments.input +
                         ": gap: expected one that is not zero: a closed gap has no energy interval to study, got 0");
    }
    if (is_extreme(scene.objective)) {
        throw InputError(fmt::format("{}: objective: expected one at a given energy, got {}", arguments.input,
                                     name(scene.objective)));
    }
    const FolderLock lock(arguments.out);
    fmt::print("{}\n", derived_text(scene));
    AccuracyFolder folder(arguments.out, scene);
    Progress progress("accuracy", arguments.quiet);
    bool whole = false;
    try {
        whole = accuracy(
            scene, arguments.quick, [&](const AccuracyRecord& record) { folder.add(record); },
            [&](long done, long total) {
                progress.show(static_cast<double>(done), static_cast<double>(total));
                return !stop_requested();
            });
    } catch (const Interrupted&) {  // in the middle of a piece of work
    }
    progress.clear();
    if (!whole) {
        fmt::print("interrupted: the rows so far are in {} as .part files\n", arguments.out);
        return exit_interrupted;
    }
    folder.finish();
    fmt::print("results are in {}\n", arguments.out);
    draw_if_possible(accuracy_charts(folder.results()), arguments.out);
    return exit_done;
}

}  // namespace nsma::app
