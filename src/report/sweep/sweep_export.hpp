#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sweep_store.hpp"

namespace nsma {

/// Where the solving time of a sweep went, over all runs and processes.
struct TimeSpent {
    double seconds = 0;       ///< of all verdicts and answers
    double open_seconds = 0;  ///< of answers whose orbit is not proved the best
    int open_levels = 0;
};
/// One line where most of a time worth mentioning went to answers that stayed unproved, and which number of starts, of
/// now `starts`, spends less on them; else empty.
[[nodiscard]] std::string open_time_text(const TimeSpent& spent, int starts);

/// Writes patterns.csv, levels.csv, orbits.jsonl, timings.csv and the summary of a store into
/// its folder, each complete or not at all; a part file never replaces complete results. `distinct` leaves answers out
/// whose motion one before at the same level has under another label. `line` tells the user where they are.
/// `span`: the least and the greatest energy of all patterns that are solved, in energy units; a bar without a gap and
/// patterns without such orbits have none.
struct Exported {
    SweepSummary summary;
    std::string line;
    std::optional<std::array<double, 2>> span = {};
    TimeSpent spent = {};
};
[[nodiscard]] Exported export_sweep(const SweepStore& store, const std::filesystem::path& folder,
                                    bool distinct = false);

/// Writes curves.csv, the curves of every stored orbit in the scene's order; unless `asked` only where there is one,
/// which would else be of other orbits.
void export_curves(const SweepStore& store, const std::filesystem::path& folder, bool asked);

/// A stored answer, as far as charts need it.
struct StoredLevel {
    Pattern pattern;
    std::optional<double> level;  ///< in energy units; absent: the least-energy orbit
    Verdict verdict = Verdict::failed;
    std::optional<double> energy;  ///< in energy units of the bar
    std::string agreement;
    bool proved = false;  ///< the best orbit of its level
};

struct StoredOrbit {
    std::optional<double> level;  ///< in energy units; absent: the least-energy orbit
    double energy = 0;            ///< in energy units of the bar
    Orbit orbit;                  ///< rebuilt from the stored amplitudes
};

struct StoredSweep {
    Scene scene;
    std::vector<PatternRecord> patterns;
    std::vector<StoredLevel> levels;
    std::vector<StoredOrbit> orbits;
};

/// Reads the store of a finished (or interrupted) sweep back. Throws InputError when it is missing or damaged.
[[nodiscard]] StoredSweep read_sweep_folder(const std::filesystem::path& folder);

}  // namespace nsma
