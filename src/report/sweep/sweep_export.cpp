#include "sweep_export.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "seen_motions.hpp"
#include "sweep_folder.hpp"
#include "tables.hpp"

namespace nsma {

namespace fs = std::filesystem;

std::string open_time_text(const TimeSpent& spent, int starts) {
    constexpr double worth_mentioning = 10;
    if (spent.seconds < worth_mentioning || 2 * spent.open_seconds <= spent.seconds) return {};
    std::string where = fmt::format(
        "most of the time ({:.0f} of {:.0f} s) went to {} levels that stayed unproved: free patterns have "
        "many local optima",
        spent.open_seconds, spent.seconds, spent.open_levels);
    const int fewer = std::max(starts / 4, 1);
    if (fewer == starts) return where;
    return fmt::format("{}; --starts {} spends less on them, and may miss better orbits", where, fewer);
}

Exported export_sweep(const SweepStore& store, const fs::path& folder, bool distinct) {
    SweepSummary summary;
    TimeSpent spent;
    std::optional<std::array<double, 2>> span;
    std::optional<SweepFolder> files;
    SeenMotions seen;
    if (!store.beside_complete()) files.emplace(folder, store.scene());
    store.for_each([&](const WorkResult& result) {
        if (result.record) {
            count(summary, *result.record, store.scene().all_kinds);
            spent.seconds += result.record->seconds;
            const EnergyInterval& interval = result.record->interval;
            if (is_solved(store.scene().all_kinds, result.record->kind) && interval.least && interval.greatest) {
                if (!span) span = {*interval.least, *interval.greatest};
                span = {std::min((*span)[0], *interval.least), std::max((*span)[1], *interval.greatest)};
            }
            if (files) files->pattern(*result.record);
        }
        if (result.answer) {
            count(summary, *result.answer, result.place > 0);
            spent.seconds += result.answer->seconds;
            if (result.answer->orbit && !proved_best(*result.answer)) {
                spent.open_seconds += result.answer->seconds;
                ++spent.open_levels;
            }
            const bool copy = seen.before(*result.answer, result.place);
            if (copy && result.place > 0) ++summary.copies;
            if (files) files->answer(*result.answer, copy && distinct);
        }
    });
    summary.seconds = store.seconds();
    summary.interrupted = !store.complete();
    if (!files) {
        return {summary,
                fmt::format("interrupted: {} keeps its complete results; what was done now is in {}, and "
                            "--resume goes on with it",
                            folder.string(), store.file_name()),
                span, spent};
    }
    files->finish(summary);
    const char* const line = summary.interrupted ? "interrupted: partial results are in {}; --resume goes on with them"
                                                 : "results are in {}";
    return {summary, fmt::format(fmt::runtime(line), folder.string()), span, spent};
}

void export_curves(const SweepStore& store, const fs::path& folder, bool asked) {
    const fs::path curves = folder / "curves.csv";
    if (std::error_code code; !asked && !fs::exists(curves, code)) return;
    PartFile file(curves);
    file.write(curves_csv_header() + "\n");
    store.for_each([&](const WorkResult& result) {
        if (result.answer && result.answer->orbit)
            file.write(curves_csv_rows(*result.answer->orbit, result.answer->level));
    });
    file.put_in_place();
    write_csv_metadata(folder, store.scene().title);
}

StoredSweep read_sweep_folder(const fs::path& folder) {
    const SweepStore store(folder);
    StoredSweep sweep;
    sweep.scene = store.scene();
    store.for_each([&sweep](WorkResult result) {
        if (result.record) sweep.patterns.push_back(std::move(*result.record));
        if (!result.answer) return;
        OrbitAnswer& answer = *result.answer;
        sweep.levels.push_back({answer.pattern, answer.level, answer.verdict, answer.energy,
                                std::string(name(answer.agreement)), proved_best(answer)});
        if (answer.orbit) {
            sweep.orbits.push_back({answer.level, answer.energy.value_or(0.0), std::move(*answer.orbit)});
        }
    });
    return sweep;
}

}  // namespace nsma
