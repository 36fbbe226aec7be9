#include "report/accuracy/accuracy_folder.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using nsma::AccuracyFolder;
using nsma::Outcome;
using nsma::ProgramRecord;

class AccuracyFolderTest : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("nsma-accuracy-" + std::to_string(getpid()) + "-" +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        scene_.text = "title = \"one\"\n";
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string contents(const char* name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name).rdbuf();
        return text.str();
    }

    fs::path folder_;
    nsma::Scene scene_;
};

ProgramRecord program(const char* method, int size, double seconds, double error) {
    ProgramRecord record;
    record.pattern = {5 * size / 2, 6 * size, 2 * size};
    record.size = size;
    record.method = method;
    record.setting = "tol 1e-08, polish";
    record.runs = record.outcomes[0] = 3;
    record.seconds = {seconds, 0.9 * seconds, 1.1 * seconds};
    record.error = error;
    return record;
}

void fill(AccuracyFolder& folder) {
    folder.add(program("SLSQP", 2, 1e-4, 1e-15));
    folder.add(program("Ipopt", 2, 1e-2, 1e-9));
    folder.add(program("SLSQP", 8, 1e-3, 1e-15));
    folder.add(nsma::KernelRecord{{5, 12, 4}, "exact cycles", {1e-6, 1e-6, 2e-6}, 2, 2, 0.0});
    folder.add(nsma::MarchRecord{5, "wave queue", "", true, 16, {1e-6, 1e-6, 1e-6}, 0.0, 0.0});
    folder.add(nsma::DriftRecord{5, "FE, \"quoted\"", "a, b", 10, 1e-3, 1e-2, 0.1});
    nsma::StabilityRecord cell;
    cell.map = "level";
    cell.pattern = {5, 12, 4};
    cell.size = 2;
    cell.method = "SLSQP";
    cell.difficulty = "E_min (1 + 1e-08)";
    cell.runs = cell.reported = 2;
    cell.outcomes[0] = cell.outcomes[2] = 1;
    folder.add(cell);
    cell.map = "rows";
    folder.add(cell);
    folder.add(nsma::ToleranceRecord{{5, 12, 4}, "dense SVD", 1e-9, 3, 2});
}

TEST_F(AccuracyFolderTest, WritesEveryTableAndDrawsEveryChart) {
    AccuracyFolder folder(folder_, scene_);
    fill(folder);
    EXPECT_TRUE(fs::exists(folder_ / "programs.csv.part"));
    EXPECT_FALSE(fs::exists(folder_ / "programs.csv"));
    folder.finish();
    for (const char* file : nsma::accuracy_files) {
        EXPECT_TRUE(fs::file_size(folder_ / file) > 0) << file;
        EXPECT_FALSE(fs::exists((folder_ / file).string() + ".part"));
    }
    EXPECT_EQ(contents("scene.toml"), scene_.text);
    EXPECT_NE(contents("drift.csv").find("5,\"FE, \"\"quoted\"\"\",\"a, b\",10,0.001,0.01,0.1"), std::string::npos);
    EXPECT_NE(contents("causes.csv").find("SLSQP,level,off-level,1,2,"), std::string::npos);
    EXPECT_NE(contents("winners.csv").find("2,any,1,SLSQP"), std::string::npos);
    EXPECT_EQ(contents("winners.csv").find("Ipopt"), std::string::npos);
    EXPECT_NE(contents("machine.txt").find("Ipopt: "), std::string::npos);
    const auto pictures = nsma::draw_charts(nsma::accuracy_charts(folder.results()), folder_ / "charts");
    EXPECT_GE(pictures.size(), 8U);
    for (const auto& picture : pictures) EXPECT_TRUE(fs::exists(picture)) << picture;
}

TEST_F(AccuracyFolderTest, TakesTheSameSceneAgainAndNoOther) {
    {
        AccuracyFolder folder(folder_, scene_);
        fill(folder);
        folder.finish();
    }
    EXPECT_NO_THROW(AccuracyFolder(folder_, scene_));
    nsma::Scene other = scene_;
    other.text = "title = \"two\"\n";
    EXPECT_THROW(AccuracyFolder(folder_, other), nsma::InputError);
    fs::remove(folder_ / "scene.toml");
    EXPECT_THROW(AccuracyFolder(folder_, scene_), nsma::InputError);  // tables of nobody knows what
    EXPECT_THROW(AccuracyFolder("/proc/nsma-accuracy", scene_), nsma::InputError);
    other.text.clear();
    EXPECT_THROW(AccuracyFolder(folder_, other), std::invalid_argument);
}

TEST(ParetoFront, KeepsWhatNothingBeats) {
    const std::vector<ProgramRecord> records{
        program("fast and rough", 8, 1e-5, 1e-3),  program("beaten", 8, 1e-2, 1e-3),
        program("exact", 8, 1e-3, 1e-15),          program("as exact within rounding and noise", 8, 1.05e-3, 2e-16),
        program("exact and slow", 8, 2e-3, 1e-16), program("of another size", 2, 1e-6, 0)};
    std::vector<std::string> names;
    for (const auto* record : nsma::pareto_front(records, 8)) names.push_back(record->method);
    EXPECT_EQ(names, (std::vector<std::string>{"fast and rough", "exact", "as exact within rounding and noise"}));
    EXPECT_TRUE(nsma::pareto_front(records, 32).empty());
}

TEST(ParetoFront, OfCertifiedAnswersLeavesOutTheOthers) {
    std::vector<ProgramRecord> records{program("fast", 8, 1e-5, 1e-15), program("proved", 8, 1e-3, 1e-15),
                                       program("proved in part", 8, 1e-4, 1e-15),
                                       program("proved slowly", 8, 1e-2, 1e-15)};
    records[1].certified = records[3].certified = 3;
    records[2].certified = 2;
    const auto front = nsma::pareto_front(records, 8, true);
    ASSERT_EQ(front.size(), 1U);
    EXPECT_EQ(front.front()->method, "proved");
    EXPECT_EQ(nsma::pareto_front(records, 8).front()->method, "fast");
}

TEST(AccuracyCharts, NothingToShowIsNoChart) { EXPECT_TRUE(nsma::accuracy_charts({}).empty()); }

}  // namespace
