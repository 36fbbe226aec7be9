#include "report/sweep/sweep_folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sample.hpp"
#include "nsma/report/scene_file.hpp"

namespace nsma {
namespace {

using sample::error_of;
using testing::HasSubstr;

class SweepFolderTest : public sample::Folder {
protected:
    Scene scene = parse_scene(sample::scene_text, "sample");

    std::string sweep(bool interrupted = false) {
        SweepFolder folder(path / "out", scene);
        sample::fill(folder, scene);
        SweepSummary summary;
        summary.patterns = 19;
        summary.interrupted = interrupted;
        return folder.finish(summary);
    }
    [[nodiscard]] std::string file(const char* name) const { return sample::read(path / "out" / name); }
};

TEST_F(SweepFolderTest, FilesTakeTheirNamesAtTheEnd) {
    SweepFolder folder(path / "out", scene);
    sample::fill(folder, scene);
    EXPECT_FALSE(std::filesystem::exists(path / "out" / "levels.csv"));
    // Rows are there as they come.
    EXPECT_THAT(file("levels.csv.part"), HasSubstr("20,1,48,16,64,"));
    EXPECT_THAT(folder.finish({}), HasSubstr("results are in"));
    for (const char* name : sweep_files) {
        EXPECT_TRUE(std::filesystem::exists(path / "out" / name)) << name;
        EXPECT_FALSE(std::filesystem::exists(path / "out" / (std::string(name) + ".part"))) << name;
    }
    EXPECT_EQ(file("scene.toml"), sample::scene_text);
    EXPECT_FALSE(nlohmann::json::parse(file("summary.json"))["interrupted"].get<bool>());
}

TEST_F(SweepFolderTest, ReadsBackWhatWasWritten) {
    (void)sweep();
    const StoredSweep stored = read_sweep_folder(path / "out");
    EXPECT_EQ(stored.scene.title, "A sample");
    ASSERT_EQ(stored.patterns.size(), 19U);
    ASSERT_EQ(stored.levels.size(), 19U);
    ASSERT_EQ(stored.orbits.size(), 19U);
    for (std::size_t i = 0; i < stored.orbits.size(); ++i) {
        const OrbitAnswer answer = sample::least_energy_answer(scene.bar, stored.patterns[i].pattern);
        EXPECT_EQ(stored.patterns[i].interval.least, answer.interval.least);
        EXPECT_EQ(stored.patterns[i].verdict, Verdict::admissible);
        EXPECT_EQ(stored.levels[i].energy, answer.energy);
        EXPECT_FALSE(stored.levels[i].level.has_value());
        // Two roundings: alpha = beta u/dt and back.
        EXPECT_TRUE(stored.orbits[i].orbit.beta.isApprox(answer.orbit->beta, 1e-15));
    }
}

TEST_F(SweepFolderTest, TwoRunsOfOneSceneAreTheSame) {
    (void)sweep();
    const std::string patterns = file("patterns.csv"), levels = file("levels.csv"), orbits = file("orbits.jsonl");
    (void)sweep();
    EXPECT_EQ(file("patterns.csv"), patterns);
    EXPECT_EQ(file("levels.csv"), levels);
    EXPECT_EQ(file("orbits.jsonl"), orbits);
}

TEST_F(SweepFolderTest, AnotherSceneIsRefused) {
    (void)sweep();
    const std::string before = file("levels.csv");
    scene.text += "# changed\n";
    const std::string message = error_of([this] { SweepFolder(path / "out", scene); });
    EXPECT_THAT(message, HasSubstr("holds results of another scene"));
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_EQ(file("levels.csv"), before);
}

TEST_F(SweepFolderTest, AnInterruptedSweepKeepsCompleteResults) {
    (void)sweep();
    const std::string before = file("summary.json");
    EXPECT_THAT(sweep(true), HasSubstr("keeps its complete results"));
    EXPECT_EQ(file("summary.json"), before);
    EXPECT_THAT(file("summary.txt.part"), HasSubstr("interrupted"));
    EXPECT_THAT(file("levels.csv.part"), HasSubstr("20,1,48,16,64,"));
    EXPECT_THAT(sweep(), HasSubstr("results are in"));
    EXPECT_FALSE(std::filesystem::exists(path / "out" / "levels.csv.part"));
}

TEST_F(SweepFolderTest, AnInterruptedSweepLeavesWhatItHas) {
    EXPECT_THAT(sweep(true), HasSubstr("partial results are in"));
    EXPECT_THAT(file("summary.txt"), HasSubstr("interrupted"));
    EXPECT_EQ(read_sweep_folder(path / "out").orbits.size(), 19U);
    EXPECT_THAT(sweep(true), HasSubstr("partial results are in"));
}

TEST_F(SweepFolderTest, ThingsInTheWayAreNamed) {
    sample::write(path / "file", "text");
    EXPECT_THAT(error_of([this] { SweepFolder(path / "file", scene); }), HasSubstr("got a file"));
    EXPECT_THAT(error_of([this] { SweepFolder(path / "file" / "out", scene); }), HasSubstr("file/out"));
    EXPECT_THAT(error_of([this] { SweepFolder("/proc/nsma", scene); }), HasSubstr("/proc/nsma: cannot be"));
    std::filesystem::create_directory(path / "old");
    sample::write(path / "old" / "levels.csv", "text");
    EXPECT_THAT(error_of([this] { SweepFolder(path / "old", scene); }), HasSubstr("is in the way"));
    std::filesystem::create_directories(path / "taken" / "levels.csv.part");
    EXPECT_THAT(error_of([this] { SweepFolder(path / "taken", scene); }),
                HasSubstr("levels.csv.part: cannot be written"));
}

TEST_F(SweepFolderTest, AFullDiskIsOneLine) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    std::filesystem::create_directory(path / "out");
    std::filesystem::create_symlink("/dev/full", path / "out" / "levels.csv.part");
    const std::string message = error_of([this] { SweepFolder(path / "out", scene); });
    EXPECT_THAT(message, HasSubstr("levels.csv.part: cannot be written: No space left on device"));
}

TEST_F(SweepFolderTest, ASceneMadeInCodeIsMisuse) {
    scene.text.clear();
    EXPECT_THROW(SweepFolder(path / "out", scene), std::invalid_argument);
}

TEST_F(SweepFolderTest, DamagedFoldersAreNamed) {
    const auto message = [this] { return error_of([this] { (void)read_sweep_folder(path / "out"); }); };
    EXPECT_THAT(message(), HasSubstr("got nothing"));
    (void)sweep();
    std::filesystem::rename(path / "out" / "levels.csv", path / "levels.csv");
    EXPECT_THAT(message(), HasSubstr("without levels.csv"));
    sample::write(path / "out" / "levels.csv", "");
    EXPECT_THAT(message(), HasSubstr("levels.csv: expected a row of column names"));
    sample::write(path / "out" / "levels.csv", "cells,gap\n20\n");
    EXPECT_THAT(message(), HasSubstr("levels.csv:2: expected 2 fields, got 1"));
    sample::write(path / "out" / "levels.csv", "cells,gap\n20,x\n");
    EXPECT_THAT(message(), HasSubstr("expected a column free_steps"));
    std::string levels = sample::read(path / "levels.csv");
    levels.replace(levels.find(",admissible,"), 12, ",splendid,");
    sample::write(path / "out" / "levels.csv", levels);
    EXPECT_THAT(message(), HasSubstr("verdict: expected a verdict, got \"splendid\""));
    std::filesystem::rename(path / "levels.csv", path / "out" / "levels.csv");
    EXPECT_EQ(message(), "no error");
    sample::write(path / "out" / "orbits.jsonl", file("orbits.jsonl") + "{\"cells\": 20}\n");
    EXPECT_THAT(message(), HasSubstr("orbits.jsonl:20: expected an orbit"));
    sample::write(path / "out" / "orbits.jsonl", "not json\n");
    EXPECT_THAT(message(), HasSubstr("orbits.jsonl:1:"));
    EXPECT_EQ(message().find('\n'), std::string::npos);
}

}  // namespace
}  // namespace nsma
