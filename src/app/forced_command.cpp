#include <fmt/format.h>

#include "command.hpp"
#include "draw.hpp"
#include "progress.hpp"

#include "nsma/numerics/interruption.hpp"
#include "nsma/report/input_error.hpp"
#include "report/bar_text.hpp"
#include "report/folder_lock.hpp"
#include "report/forced/forced_folder.hpp"

namespace nsma::app {

int run_forced(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    if (!scene.forcing)
        throw InputError(arguments.input + ": forcing: expected a table [forcing], got nothing: the key is missing");
    const FolderLock lock(arguments.out);
    const std::filesystem::path part =
        std::filesystem::path(arguments.out) / (std::string(forced_records_name) + ".part");
    const bool interrupted = std::filesystem::exists(part);
    if (interrupted && !arguments.resume && !arguments.fresh) {
        throw InputError(
            part.string() +
            ": is an interrupted run: expected --resume to go on with it or --fresh to begin anew, got none");
    }
    ForcedFolder folder(arguments.out, scene, arguments.resume && interrupted);
    fmt::print("{}\n", derived_text(scene));
    const Forcing& forcing = *scene.forcing;
    const auto total =
        static_cast<double>(forcing.frequencies.size()) * ((forcing.up ? 1 : 0) + (forcing.down ? 1 : 0));
    auto count = static_cast<double>(folder.known().size());
    Progress progress("forced", arguments.quiet, count);
    const auto points = forced_response(scene, folder.known(), [&](const ForcedPoint& point) {
        folder.add(point);
        progress.show(++count, total);
    });
    progress.clear();
    if (static_cast<double>(points.size()) < total) {
        fmt::print("interrupted: the points so far are in {}; --resume goes on with them\n", part.string());
        return exit_interrupted;
    }
    folder.finish(points);
    fmt::print("{}results are in {}\n", forced_text(scene, points), arguments.out);
    draw_if_possible(forced_charts(scene, points), arguments.out);
    return exit_done;
}

}  // namespace nsma::app
