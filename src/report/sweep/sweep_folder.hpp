#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"
#include "report/csv_metadata.hpp"
#include "report/results_folder.hpp"

namespace nsma {

/// The store of a sweep: its name once complete, and until then.
inline constexpr const char* store_name = "results.sqlite";
inline constexpr const char* store_part_name = "results.sqlite.part";

/// Certificates of the orbits of a sweep with --certify.
inline constexpr const char* certificates_name = "certificates.jsonl";

/// Files of a sweep in its folder, beside scene.toml; columns and units: data/README.md.
inline constexpr std::array<const char*, 8> sweep_files{"patterns.csv",    "levels.csv",     "orbits.jsonl",
                                                        "timings.csv",     "summary.txt",    "summary.json",
                                                        certificates_name, csv_metadata_name};

/// Makes the folder if missing and puts the scene in it. Throws InputError when that cannot be
/// done or the folder holds another scene's results, std::invalid_argument unless scene.text is
/// the scene file as read. Returns the folder.
std::filesystem::path prepare_sweep_folder(const std::filesystem::path& folder, const Scene& scene);

/// Throws InputError unless there is such a folder, readable and with the results of a sweep.
void expect_sweep_folder(const std::filesystem::path& folder);

/// Writes the tables of a sweep into its prepared folder, row by row. All files are complete and take their names in
/// finish(). Throws InputError (one line) when the folder cannot be made or written, or holds another scene's results.
class SweepFolder {
public:
    SweepFolder(const std::filesystem::path& folder, const Scene& scene);

    void pattern(const PatternRecord& record);
    void answer(const OrbitAnswer& answer, bool only_times = false);  ///< only_times: its rows of timings.csv alone
    void finish(const SweepSummary& summary);

private:
    std::filesystem::path folder_;
    Bar bar_;
    std::string title_;
    PartFile patterns_, levels_, orbits_, timings_;
    std::optional<PartFile> certificates_;  // only where there are some
};

}  // namespace nsma
