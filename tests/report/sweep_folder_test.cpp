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

    void fill(SweepFolder& folder) {
        for (const WorkResult& result : sample::results_of(scene)) {
            if (result.record) folder.pattern(*result.record);
            if (result.answer) folder.answer(*result.answer);
        }
    }
    void sweep() {
        SweepFolder folder(path / "out", scene);
        fill(folder);
        SweepSummary summary;
        summary.patterns = 19;
        folder.finish(summary);
    }
    [[nodiscard]] std::string file(const char* name) const { return sample::read(path / "out" / name); }
};

TEST_F(SweepFolderTest, FilesTakeTheirNamesAtTheEnd) {
    SweepFolder folder(path / "out", scene);
    fill(folder);
    EXPECT_FALSE(std::filesystem::exists(path / "out" / "levels.csv"));
    // Rows are there as they come.
    EXPECT_THAT(file("levels.csv.part"), HasSubstr("20,1,48,16,64,"));
    folder.finish({});
    for (const char* name : sweep_files) {
        const bool expected = std::string_view(name) != certificates_name;  // the sample has none
        EXPECT_EQ(std::filesystem::exists(path / "out" / name), expected) << name;
        EXPECT_FALSE(std::filesystem::exists(path / "out" / (std::string(name) + ".part"))) << name;
    }
    EXPECT_EQ(file("scene.toml"), sample::scene_text);
    EXPECT_FALSE(nlohmann::json::parse(file("summary.json"))["interrupted"].get<bool>());
}

TEST_F(SweepFolderTest, TwoRunsOfOneSceneAreTheSame) {
    sweep();
    const std::string patterns = file("patterns.csv"), levels = file("levels.csv"), orbits = file("orbits.jsonl");
    sweep();
    EXPECT_EQ(file("patterns.csv"), patterns);
    EXPECT_EQ(file("levels.csv"), levels);
    EXPECT_EQ(file("orbits.jsonl"), orbits);
}

TEST_F(SweepFolderTest, AnotherSceneIsRefused) {
    sweep();
    const std::string before = file("levels.csv");
    scene.text += "# changed\n";
    const std::string message = error_of([this] { SweepFolder(path / "out", scene); });
    EXPECT_THAT(message, HasSubstr("holds results of another scene"));
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_EQ(file("levels.csv"), before);
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

}  // namespace
}  // namespace nsma
