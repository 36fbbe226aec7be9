#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "study/accuracy/accuracy_records.hpp"
#include "nsma/report/input_error.hpp"
#include "report/charts.hpp"

namespace nsma {

/// Everything that one accuracy study found, in the order it was found.
struct AccuracyResults {
    std::vector<ProgramRecord> programs;
    std::vector<KernelRecord> kernels;
    std::vector<MarchRecord> marches;
    std::vector<DriftRecord> drifts;
    std::vector<StabilityRecord> stability;
    std::vector<ToleranceRecord> tolerances;
};

/// Files of a study in its folder, beside scene.toml; columns and units: data/README.md.
inline constexpr std::array<const char*, 9> accuracy_files{"programs.csv",  "kernels.csv",   "marching.csv",
                                                           "drift.csv",     "stability.csv", "causes.csv",
                                                           "tolerance.csv", "winners.csv",   "machine.txt"};

/// Writes an accuracy study into a folder as its records come, one CSV row each; rows go to
/// NAME.part files that take their final names in finish(). Keeps the records for the charts.
/// Throws InputError (one line) when the folder cannot be made or written, or holds another
/// scene's results.
class AccuracyFolder : public AccuracySink {
public:
    AccuracyFolder(const std::filesystem::path& folder, const Scene& scene);
    ~AccuracyFolder() override;
    AccuracyFolder(const AccuracyFolder&) = delete;
    AccuracyFolder& operator=(const AccuracyFolder&) = delete;

    void program(const ProgramRecord& record) override;
    void kernel(const KernelRecord& record) override;
    void march(const MarchRecord& record) override;
    void drift(const DriftRecord& record) override;
    void stability(const StabilityRecord& record) override;
    void tolerance(const ToleranceRecord& record) override;
    void progress(long done, long total) override;  ///< does nothing

    /// Writes the tables of causes and winners and the machine, and puts the files in place.
    void finish();
    [[nodiscard]] const AccuracyResults& results() const { return results_; }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    struct Table {
        std::filesystem::path path;
        std::unique_ptr<std::FILE, Close> file;
    };
    void open(Table& table, const char* name, const char* header);
    static void write(Table& table, const std::string& line);

    std::filesystem::path folder_;
    AccuracyResults results_;
    Table programs_, kernels_, marching_, drift_, stability_, causes_, tolerance_, winners_, machine_;
};

/// Every answer of the record was proved the best by the method itself.
[[nodiscard]] bool all_certified(const ProgramRecord& record);

/// Of a size's records with a cold start, or of those whose answers are all certified, the ones
/// that no other beats, by increasing time: one beats another when it is faster beyond the quartiles of both
/// and its error is not larger, rounding (1e-14) aside.
[[nodiscard]] std::vector<const ProgramRecord*> pareto_front(const std::vector<ProgramRecord>& records, int size,
                                                             bool certified = false);

/// CPU, compiler, build options and library versions, one line each.
[[nodiscard]] std::string machine_text();

/// The study's charts, those that have something to show.
[[nodiscard]] std::vector<Chart> accuracy_charts(const AccuracyResults& results);

}  // namespace nsma
