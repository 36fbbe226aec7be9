#include "nsma/report/sensitivity_folder.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

nsma::Scene scene(const std::string& title = "Two patterns") {
    nsma::Scene result;
    result.title = title;
    result.text = "title = \"" + title + "\"\n";
    result.mesh.cells = 6;
    result.patterns = nsma::ListSelection{{{16, 4}, {23, 1}, {5, 5}}};
    result.levels = {12.0};
    return result;
}

struct Study {
    nsma::SensitivityRecords records;
    nsma::SensitivitySummary summary;
};

Study study(const nsma::Scene& scene) {
    Study result;
    nsma::SensitivityRequest request;
    request.solver.solvers = nsma::SolverChoice::nlopt;
    request.solver.bound_nodes = 0;
    request.amounts = {0, 0.1, 0.3};
    result.summary = nsma::sensitivity(scene, request, result.records, [] { return true; });
    return result;
}

fs::path fresh(const char* name) {
    fs::path folder = fs::path(testing::TempDir()) / name;
    fs::remove_all(folder);
    return folder;
}

TEST(SensitivityFolder, EveryFileHasOneNumberOfFields) {
    const nsma::Scene two = scene();
    const Study found = study(two);
    const fs::path folder = fresh("sensitivity-files");
    nsma::open_sensitivity_folder(folder, two);
    nsma::write_sensitivity(folder, two, found.records, found.summary);
    for (const char* file : nsma::sensitivity_files) {
        std::ifstream stream(folder / file);
        ASSERT_TRUE(stream) << file;
        if (std::string(file).find(".csv") == std::string::npos) continue;
        std::size_t fields = 0;
        int rows = 0;
        for (std::string line; std::getline(stream, line);) {
            if (line.front() == '#') continue;
            bool quoted = false;
            std::size_t count = 1;
            for (const char letter : line) {
                if (letter == '"') quoted = !quoted;
                if (letter == ',' && !quoted) ++count;
            }
            if (fields == 0) fields = count;
            EXPECT_EQ(count, fields) << file << ": " << line;
            EXPECT_EQ(line.find("nan"), std::string::npos) << file << ": " << line;
            ++rows;
        }
        EXPECT_GT(rows, 1) << file;
    }
}

TEST(SensitivityFolder, RefusesAnotherScene) {
    const fs::path folder = fresh("sensitivity-other");
    nsma::open_sensitivity_folder(folder, scene());
    EXPECT_NO_THROW(nsma::open_sensitivity_folder(folder, scene()));
    EXPECT_THROW(nsma::open_sensitivity_folder(folder, scene("Another")), nsma::InputError);
    const fs::path file = fresh("sensitivity-file");
    std::ofstream(file) << "x";
    EXPECT_THROW(nsma::open_sensitivity_folder(file, scene()), nsma::InputError);
}

TEST(SensitivityFolder, FunnelsEndAtTheSameNumber) {
    const nsma::Scene two = scene();
    const auto funnels = nsma::funnels(study(two).records.ablations);
    ASSERT_EQ(funnels.size(), 6U);
    for (const auto& funnel : funnels) {
        EXPECT_EQ(funnel.left[0], funnels.front().left[0]);
        EXPECT_EQ(funnel.left[3], 2);  // (16, 4) and (23, 1) are admissible
        for (std::size_t i = 1; i < 4; ++i) EXPECT_LE(funnel.left[i], funnel.left[i - 1]);
    }
}

TEST(SensitivityFolder, DrawsEveryChart) {
    const nsma::Scene two = scene();
    const Study found = study(two);
    const fs::path folder = fresh("sensitivity-charts");
    const auto pictures = nsma::draw_sensitivity(folder, two, found.records);
    EXPECT_EQ(pictures.size(), 8U);
    for (const auto& picture : pictures) EXPECT_GT(fs::file_size(picture), 1000U) << picture;
}

}  // namespace
