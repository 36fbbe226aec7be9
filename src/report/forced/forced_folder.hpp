#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "nsma/study/scene.hpp"
#include "study/forced/forced.hpp"
#include "report/chart.hpp"
#include "report/results_folder.hpp"

namespace nsma {

/// All points of a forced response, one JSON object a line, every number as it is: what its tables and charts are made
/// from and what --resume goes on with.
inline constexpr const char* forced_records_name = "forced.jsonl";

/// Tables of a forced response in its folder, beside scene.toml; columns and units: data/README.md.
inline constexpr std::array<const char*, 3> forced_files{"response.csv", "balance.csv", "forced.txt"};

/// Takes the points of a run as they come.
class ForcedFolder {
public:
    /// Throws InputError where the folder cannot be made or written, holds another scene's results, or what an
    /// interrupted run left is not what it wrote.
    ForcedFolder(const std::filesystem::path& folder, const Scene& scene, bool resume);

    [[nodiscard]] const std::vector<ForcedPoint>& known() const { return known_; }  ///< of the interrupted run
    void add(const ForcedPoint& point);
    /// Puts all points in their order in place, and writes the tables.
    void finish(const std::vector<ForcedPoint>& points);

private:
    std::filesystem::path folder_;
    Scene scene_;
    std::vector<ForcedPoint> known_;
    PartFile part_;
};

/// The points of a finished folder. Throws InputError.
[[nodiscard]] std::vector<ForcedPoint> read_forced(const std::filesystem::path& folder, const Scene& scene);

/// Writes the tables again. Throws InputError.
void write_forced(const std::filesystem::path& folder, const Scene& scene, const std::vector<ForcedPoint>& points);

/// Counts, jumps seen and predicted, in words.
[[nodiscard]] std::string forced_text(const Scene& scene, const std::vector<ForcedPoint>& points);

/// The response over the modes with its jumps, and motions of three of its points with their Poincare sections.
[[nodiscard]] std::vector<Chart> forced_charts(const Scene& scene, const std::vector<ForcedPoint>& points);

}  // namespace nsma
