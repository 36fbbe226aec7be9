#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {

/// Files of a sweep in its folder, beside scene.toml; columns and units: data/README.md.
inline constexpr std::array<const char*, 6> sweep_files{"patterns.csv", "levels.csv",  "orbits.jsonl",
                                                        "timings.csv",  "summary.txt", "summary.json"};

/// Makes the folder if missing and puts the scene in it. Throws InputError when that cannot be
/// done or the folder holds another scene's results, std::invalid_argument unless scene.text is
/// the scene file as read.
void prepare_sweep_folder(const std::filesystem::path& folder, const Scene& scene);

/// Writes a sweep into a folder as its records come. Rows go to NAME.part files, flushed one by
/// one, which take their final names in finish(), so that a final file is always complete.
/// Throws InputError (one line) when the folder cannot be made or written, or holds another
/// scene's results.
class SweepFolder : public SweepSink {
public:
    /// Opens `folder`, makes it if missing and stores the scene in it. Throws
    /// std::invalid_argument unless scene.text is the scene file as read.
    SweepFolder(const std::filesystem::path& folder, const Scene& scene);
    ~SweepFolder() override;
    SweepFolder(const SweepFolder&) = delete;
    SweepFolder& operator=(const SweepFolder&) = delete;

    void pattern(const PatternRecord& record) override;
    void answer(const OrbitAnswer& answer) override;
    void answer(const OrbitAnswer& answer, bool only_times);  ///< only its rows of timings.csv
    void progress(long done, long total) override;            ///< does nothing

    /// Writes the summary and puts the files in place; returns one line for the user. An
    /// interrupted sweep does not replace complete results of the same scene: its rows then
    /// stay beside them as .part files.
    [[nodiscard]] std::string finish(const SweepSummary& summary);

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    struct Output {
        std::filesystem::path path;
        std::unique_ptr<std::FILE, Close> file;
    };
    Output open(const char* name);
    static void write(Output& output, const std::string& line);
    static void close(Output& output);

    std::filesystem::path folder_;
    Bar bar_;
    Output patterns_, levels_, orbits_, timings_;
};

/// A stored answer, as far as charts need it.
struct StoredLevel {
    Pattern pattern;
    std::optional<double> level;  ///< in energy units; absent: the least-energy orbit
    Verdict verdict = Verdict::failed;
    std::optional<double> energy;  ///< in energy units of the bar
    std::string agreement;
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

/// Reads a finished (or interrupted) sweep back, from its store or, where there is none, from
/// the CSV and JSONL files. Throws InputError naming file and line when a
/// file is missing or damaged.
[[nodiscard]] StoredSweep read_sweep_folder(const std::filesystem::path& folder);

}  // namespace nsma
