#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "command.hpp"
#include "draw.hpp"

#include "nsma/report/input_error.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/accuracy/accuracy_folder.hpp"
#include "report/folder_lock.hpp"
#include "report/forced/forced_folder.hpp"
#include "report/orbit_folder.hpp"
#include "report/page/report_page.hpp"
#include "report/results_folder.hpp"
#include "report/sensitivity/sensitivity_charts.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"
#include "report/study_records.hpp"
#include "report/sweep/sweep_charts.hpp"
#include "report/sweep/sweep_export.hpp"
#include "report/sweep/sweep_folder.hpp"

namespace nsma::app {
namespace {

namespace fs = std::filesystem;

// What the program wrote into a folder; several studies of one scene may share it.
struct Contents {
    fs::path folder;
    bool sweep = false;
    bool orbit = false;
    bool accuracy = false;
    bool forced = false;
    bool sensitivity = false;
};

Contents contents_of(const fs::path& folder) {
    expect_folder(folder, "the folder of a sweep, an orbit or a finished study");
    const auto holds = [&folder](const char* file) {
        std::error_code code;
        const bool found = fs::exists(folder / file, code);
        if (code) fail(folder / file, fmt::format("cannot be read: {}", code.message()));
        return found;
    };
    Contents contents{folder,
                      holds(store_name) || holds(store_part_name),
                      holds(orbit_json_name),
                      holds(accuracy_records_name),
                      holds(forced_records_name),
                      holds(sensitivity_records_name)};
    if (contents.sweep || contents.orbit || contents.accuracy || contents.forced || contents.sensitivity)
        return contents;
    fail(
        folder,
        fmt::format("expected the folder of a sweep, an orbit or a finished study, got one without {}, {}, {}, {} "
                    "and {}",
                    store_name, orbit_json_name, accuracy_records_name, forced_records_name, sensitivity_records_name));
}

// An option that only a sweep's folder has a meaning for.
void expect_sweep(const Contents& contents, bool given, const char* option) {
    if (given && !contents.sweep) {
        throw InputError(fmt::format("command line: {}: expected the folder of a sweep, got another: {}", option,
                                     contents.folder.string()));
    }
}

Scene scene_of(const Contents& contents) { return read_scene(contents.folder / "scene.toml"); }

std::vector<Chart> charts_in(const Contents& contents) {
    std::vector<Chart> charts;
    const auto add = [&charts](std::vector<Chart> more) {
        std::move(more.begin(), more.end(), std::back_inserter(charts));
    };
    if (contents.sweep) add(sweep_charts(read_sweep_folder(contents.folder)));
    if (contents.orbit) {
        const auto [scene, orbit] = read_orbit_folder(contents.folder);
        add(charts_of(scene, orbit, "orbit"));
    }
    if (contents.accuracy) add(accuracy_charts(read_accuracy_records(contents.folder)));
    if (contents.forced) {
        const Scene scene = scene_of(contents);
        add(forced_charts(scene, read_forced(contents.folder, scene)));
    }
    if (contents.sensitivity) {
        Scene scene = scene_of(contents);
        const SensitivityRecords records = read_sensitivity_records(contents.folder, scene);
        add(sensitivity_charts(scene, records));
    }
    return charts;
}

}  // namespace

int run_export(const Arguments& arguments) {
    const fs::path folder = arguments.input;
    const Contents contents = contents_of(folder);
    expect_sweep(contents, arguments.distinct, "--distinct");
    expect_sweep(contents, arguments.curves, "--curves");
    const FolderLock lock(folder);
    std::string line = "results are in " + folder.string();
    if (contents.orbit) write_orbit_curves(folder, read_orbit_folder(folder).orbit);
    if (contents.accuracy) write_accuracy(folder, scene_of(contents), read_accuracy_records(folder));
    if (contents.forced) {
        const Scene scene = scene_of(contents);
        write_forced(folder, scene, read_forced(folder, scene));
    }
    if (contents.sensitivity) {
        Scene scene = scene_of(contents);
        const SensitivityRecords records = read_sensitivity_records(folder, scene);
        write_sensitivity(folder, scene, records);
    }
    if (contents.sweep) {
        const SweepStore store(folder);
        line = export_sweep(store, folder, arguments.distinct).line;
        export_curves(store, folder, arguments.curves);
    }
    fmt::print("{}\n", line);
    return exit_done;
}

int run_report(const Arguments& arguments) {
    const fs::path folder = arguments.input;
    expect_folder(folder, "the folder of a sweep or of an accuracy study");
    const FolderLock lock(folder);
    const fs::path file = arguments.out.empty() ? folder / report_name : fs::path(arguments.out);
    write_whole(file, report_page(folder, version()));
    fmt::print("report   {}\n", file.string());
    return exit_done;
}

int run_plot(const Arguments& arguments) {
    const Contents contents = contents_of(arguments.input);
    const bool one_orbit = arguments.free_steps > 0;
    expect_sweep(contents, one_orbit, "--orbit");
    const FolderLock lock(contents.folder);
    std::vector<Chart> charts;
    if (one_orbit) {
        const StoredSweep sweep = read_sweep_folder(contents.folder);
        charts = charts_of(sweep, contents.folder, arguments.free_steps, arguments.contact_steps,
                           arguments.level(sweep.scene));
    } else {
        charts = charts_in(contents);
    }
    draw(charts, contents.folder, arguments.quiet, arguments.drawing);
    return exit_done;
}

}  // namespace nsma::app
