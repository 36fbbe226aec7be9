#include <array>
#include <cstdio>

#include <fmt/format.h>

#include "commands.hpp"
#include "progress.hpp"

#include "nsma/study/scan.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/sweep/tables.hpp"

namespace nsma::app {

Scene load_scene(const SceneArguments& arguments) {
    Scene scene = read_scene(arguments.file);
    if (arguments.cells) scene.mesh.cells = *arguments.cells;
    if (arguments.gap) scene.bar.gap = *arguments.gap;
    try {
        validate(scene.bar);
        validate(scene.mesh);
    } catch (const std::invalid_argument& error) {
        throw InputError(std::string("command line: ") + error.what());
    }
    return scene;
}

int run(const ScanArguments& arguments, const std::atomic<bool>& stop) {
    Scene scene = load_scene(arguments.scene);
    if (arguments.period) scene.patterns = PeriodSelection{*arguments.period, std::nullopt};
    long total = 0;
    try {
        total = static_cast<long>(patterns_of(scene).size());
    } catch (const std::invalid_argument& error) {
        throw InputError("command line: " + std::string(error.what()));
    }

    std::vector<PatternRecord> shown;
    long done = 0;
    int admissible = 0;
    std::array<int, pattern_kinds.size()> kinds{};
    int failed = 0;
    Sieve sieve(scene.mesh.cells, scene.bar.gap_sign());
    SieveCounts removed;
    if (arguments.csv) fmt::print("{}\n", scan_csv_header());
    {
        Progress progress("scan", arguments.quiet);
        scan(
            scene,
            [&](const PatternRecord& record) {
                progress.show(++done, total);
                const Pattern& pattern = record.pattern;
                ++removed.of[static_cast<std::size_t>(sieve(pattern.free_steps, pattern.contact_steps).finding)];
                if (record.kind) {
                    ++admissible;
                    ++kinds.at(static_cast<std::size_t>(*record.kind));
                }
                if (record.verdict == Verdict::failed) {
                    ++failed;
                    fmt::print(stderr, "nsma: ({}, {}): {}\n", record.pattern.free_steps, record.pattern.contact_steps,
                               record.reason);
                }
                if (record.kernel_dimension == 0) return;
                if (arguments.csv) {
                    fmt::print("{}\n", scan_csv_row(scene.bar, record));
                } else {
                    shown.push_back(record);
                }
            },
            [&] { return !stop.load(); }, arguments.method);
    }
    if (!arguments.csv) {
        fmt::print("{}{} patterns, {} with a nontrivial kernel, {} admissible: {} contact, {} free, {} stuck\n",
                   scan_table(scene.bar, shown), done, shown.size(), admissible, kinds[0], kinds[1], kinds[2]);
        fmt::print(
            "decided in integers: {} trivial kernels, {} with every live class bounded from both sides, "
            "{} by COND2's row, {} by a COND1 row\n",
            removed[Finding::trivial], removed[Finding::sign_conflict], removed[Finding::wrong_side],
            removed[Finding::penetrates]);
    }
    if (std::fflush(stdout) != 0) throw InputError("stdout: expected room to write, got an error");
    if (stop.load()) return exit_interrupted;
    if (failed > 0) return exit_solver;
    return admissible > 0 ? exit_done : exit_inadmissible;
}

}  // namespace nsma::app
