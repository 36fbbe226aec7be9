#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "nsma/study/scene.hpp"
#include "study/accuracy/accuracy_records.hpp"
#include "nsma/report/input_error.hpp"
#include "report/chart.hpp"
#include "report/results_folder.hpp"

namespace nsma {

/// Files of a study in its folder, beside scene.toml; columns and units: data/README.md.
inline constexpr std::array<const char*, 9> accuracy_files{"programs.csv", "kernels.csv",   "marching.csv",
                                                           "drift.csv",    "stability.csv", "tolerance.csv",
                                                           "causes.csv",   "winners.csv",   "machine.txt"};

/// Writes an accuracy study into a folder as its records come, one CSV row each; rows go to
/// NAME.part files that take their final names in finish(). Keeps the records for the charts.
/// Throws InputError (one line) when the folder cannot be made or written, or holds another
/// scene's results.
class AccuracyFolder {
public:
    AccuracyFolder(const std::filesystem::path& folder, const Scene& scene);

    void add(const AccuracyRecord& record);
    /// Writes the tables of causes and winners and the machine, and puts the files in place.
    void finish();
    [[nodiscard]] const AccuracyResults& results() const { return results_; }

private:
    std::filesystem::path folder_;
    std::string title_;
    AccuracyResults results_;
    std::vector<PartFile> tables_;  ///< the first of accuracy_files, in the order of AccuracyRecord
};

/// Writes the tables of a study again from its records. Throws InputError.
void write_accuracy(const std::filesystem::path& folder, const Scene& scene, const AccuracyResults& results);

/// Every answer of the record was proved the best by the method itself.
[[nodiscard]] bool all_certified(const ProgramRecord& record);

/// Of a size's records with a cold start, or of those whose answers are all certified, the ones
/// that no other beats, by increasing time: one beats another when it is faster beyond the quartiles of both
/// and its error is not larger, rounding (1e-14) aside.
[[nodiscard]] std::vector<const ProgramRecord*> pareto_front(const std::vector<ProgramRecord>& records, int size,
                                                             bool certified = false);

/// The study's charts, those that have something to show.
[[nodiscard]] std::vector<Chart> accuracy_charts(const AccuracyResults& results);

}  // namespace nsma
