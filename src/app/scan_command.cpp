#include <map>

#include <unistd.h>

#include <fmt/format.h>

#include "command.hpp"
#include "kind_counts.hpp"
#include "progress.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "report/bar_text.hpp"
#include "report/sweep/tables.hpp"

namespace nsma::app {

int run_scan(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    const auto total = static_cast<double>(arguments.patterns(scene).size());
    long done = 0;
    long nontrivial = 0;
    const bool listed = std::holds_alternative<ListSelection>(scene.patterns);  // then every one is asked for
    bool failed = false;
    KindCounts admissible;
    Sieve sieve(scene.mesh.cells, scene.bar.gap_sign());
    std::map<Finding, long> decided;
    Progress progress("scan", arguments.quiet || isatty(STDOUT_FILENO) != 0);  // rows come as they are found
    const auto take = [&](const PatternRecord& record) {
        const Pattern& pattern = record.pattern;
        progress.show(static_cast<double>(++done), total, pattern);
        ++decided[sieve(pattern.free_steps, pattern.contact_steps).finding];
        if (record.kind) admissible.add(*record.kind);
        if (record.verdict == Verdict::failed) {
            failed = true;
            say("({}, {}): {}", pattern.free_steps, pattern.contact_steps, record.reason);
        }
        if (record.kernel_dimension > 0) ++nontrivial;
        if (record.kernel_dimension == 0 && !listed) return;
        fmt::print("{}\n", arguments.csv ? scan_csv_row(scene.bar, record) : scan_table_row(scene.bar, record));
    };
    if (!arguments.csv) fmt::print("{}\n", derived_text(scene));
    fmt::print("{}\n", arguments.csv ? scan_csv_header() : scan_table_header(scene.bar));
    try {
        scan(
            scene, take, [] { return !stop_requested(); }, arguments.method);
    } catch (const Interrupted&) {  // what was found until here is shown
    }
    progress.clear();
    if (!arguments.csv) {
        fmt::print("{} patterns, {} with a nontrivial kernel, {} admissible: {}\n", done, nontrivial,
                   admissible.total(), admissible.text());
        fmt::print(
            "decided in integers: {} trivial kernels, {} with every live class bounded from both sides, "
            "{} by COND2's row, {} by a COND1 row\n",
            decided[Finding::trivial], decided[Finding::sign_conflict], decided[Finding::wrong_side],
            decided[Finding::penetrates]);
    }
    if (stop_requested()) return exit_interrupted;
    if (failed) return exit_solver;
    return admissible.total() > 0 ? exit_done : exit_inadmissible;
}

}  // namespace nsma::app
