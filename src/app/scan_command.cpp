#include <map>

#include <fmt/format.h>

#include "command.hpp"
#include "kind_counts.hpp"
#include "progress.hpp"

#include "report/sweep/tables.hpp"

namespace nsma::app {

int run_scan(const Arguments& arguments, const std::atomic<bool>& stop) {
    const Scene scene = arguments.scene();
    const auto total = static_cast<long>(arguments.patterns(scene).size());
    std::vector<PatternRecord> shown;
    long done = 0;
    bool failed = false;
    KindCounts admissible;
    Sieve sieve(scene.mesh.cells, scene.bar.gap_sign());
    std::map<Finding, long> decided;
    Progress progress("scan", arguments.quiet);
    const auto take = [&](const PatternRecord& record) {
        progress.show(++done, total);
        const Pattern& pattern = record.pattern;
        ++decided[sieve(pattern.free_steps, pattern.contact_steps).finding];
        if (record.kind) admissible.add(*record.kind);
        if (record.verdict == Verdict::failed) {
            failed = true;
            fmt::print(stderr, "nsma: ({}, {}): {}\n", pattern.free_steps, pattern.contact_steps, record.reason);
        }
        if (record.kernel_dimension == 0) return;
        if (arguments.csv) {
            fmt::print("{}\n", scan_csv_row(scene.bar, record));
        } else {
            shown.push_back(record);
        }
    };
    if (arguments.csv) fmt::print("{}\n", scan_csv_header());
    scan(
        scene, take, [&] { return !stop.load(); }, arguments.method);
    progress.clear();
    if (!arguments.csv) {
        fmt::print("{}{} patterns, {} with a nontrivial kernel, {} admissible: {}\n", scan_table(scene.bar, shown),
                   done, shown.size(), admissible.total(), admissible.text());
        fmt::print(
            "decided in integers: {} trivial kernels, {} with every live class bounded from both sides, "
            "{} by COND2's row, {} by a COND1 row\n",
            decided[Finding::trivial], decided[Finding::sign_conflict], decided[Finding::wrong_side],
            decided[Finding::penetrates]);
    }
    if (stop.load()) return exit_interrupted;
    if (failed) return exit_solver;
    return admissible.total() > 0 ? exit_done : exit_inadmissible;
}

}  // namespace nsma::app
