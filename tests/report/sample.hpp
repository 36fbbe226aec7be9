#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "nsma/orbit/backbone.hpp"
#include "nsma/orbit/conditions.hpp"
#include "report/sweep/sweep_export.hpp"
#include "report/sweep/sweep_folder.hpp"

namespace nsma::sample {

inline constexpr const char* scene_text = R"(title = "A sample"
[bar]
length = 1.0
young_modulus = 1.0
density = 1.0
area = 1.0
gap = 1.0
[mesh]
cells = 20
[patterns]
mode = 1
[levels]
list = [4.5, 6.0]
[program]
objective = "least-shock"
)";

/// The least-energy orbit of a pattern of mode 1: the shortest beta with x_0 = d.
inline OrbitAnswer least_energy_answer(const Bar& bar, const Pattern& pattern) {
    const Kernel kernel = exact_kernel(pattern);
    const Eigen::VectorXd row = contact_row(kernel).cast<double>();
    OrbitAnswer answer;
    answer.pattern = pattern;
    answer.gap_sign = bar.gap_sign();
    answer.kernel_dimension = kernel.dimension();
    answer.verdict = Verdict::admissible;
    answer.kind = pattern_kind(pattern);
    answer.method = "closed-form";
    answer.orbit = make_orbit(bar, kernel, bar.gap_sign() * row / row.squaredNorm());
    answer.energy = energy_ratio(*answer.orbit);
    answer.interval.least = answer.energy;
    answer.interval.greatest = *answer.energy * kernel.dimension();
    answer.replay = replay(*answer.orbit);
    answer.classification = classify(*answer.orbit);
    return answer;
}

inline PatternRecord record_of(const OrbitAnswer& answer) {
    PatternRecord record;
    record.pattern = answer.pattern;
    record.gap_sign = answer.gap_sign;
    record.kernel_dimension = answer.kernel_dimension;
    record.verdict = answer.verdict;
    record.kind = answer.kind;
    record.interval = answer.interval;
    return record;
}

/// Every pattern of mode 1 with its least-energy orbit, as a sweep would give them.
inline std::vector<WorkResult> results_of(const Scene& scene) {
    std::vector<WorkResult> results;
    long number = 0;
    for (const Pattern& pattern : mode_patterns(1, scene.mesh.cells, scene.bar.gap_sign())) {
        const OrbitAnswer answer = least_energy_answer(scene.bar, pattern);
        results.push_back({number, -1, record_of(answer), std::nullopt});
        results.push_back({number, 0, std::nullopt, answer});
        ++number;
    }
    return results;
}

/// A folder with the store of these results.
inline void store(const std::filesystem::path& folder, const Scene& scene, const std::vector<WorkResult>& results) {
    SweepStore store(folder, scene, {"nsma 1", "solver both"}, SweepStore::Mode::fresh);
    store.put(results);
    store.finish();
}

/// The fields of one CSV line.
inline std::vector<std::string> csv_fields(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char letter = line[i];
        if (letter == '"') {
            if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
                fields.back() += '"';
                ++i;
            } else {
                quoted = !quoted;
            }
        } else if (letter == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += letter;
        }
    }
    return fields;
}

inline std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

/// A fresh folder a test, removed with it.
class Folder : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "nsma-report-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        path = name;
    }
    void TearDown() override { std::filesystem::remove_all(path); }

    std::filesystem::path path;
};

/// What an InputError says, or "no error".
template <typename Call>
std::string error_of(Call&& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace nsma::sample
