// The folder of a forced response: what is read back is what was written, and what is damaged is refused.
#include "report/forced/forced_folder.hpp"

#include <gmock/gmock.h>

#include "sample.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/state_file.hpp"

namespace {

using namespace nsma;
using sample::error_of;
using testing::HasSubstr;

std::string scene_text(const std::string& forcing) {
    return std::string(sample::scene_text) + "[damping]\nkind = \"tip\"\nvalue = 0.02\n" + forcing;
}
constexpr const char* forcing =
    "[forcing]\namplitude = 0.05\nfrom = 0.99\nto = 1.08\ncount = 4\nsettle = 20\nrecord = 10\n";

class ForcedFolderTest : public sample::Folder {
protected:
    std::vector<ForcedPoint> run(bool resume, int stop_after = -1) {
        ForcedFolder folder(path, scene, resume);
        auto points = forced_response(scene, folder.known(), [&](const ForcedPoint& point) {
            if (stop_after < 0 || told++ < stop_after) folder.add(point);
        });
        if (stop_after < 0) folder.finish(points);
        return points;
    }
    [[nodiscard]] std::string file(const char* name) const { return sample::read(path / name); }

    Scene scene = parse_scene(scene_text(forcing), "test");
    int told = 0;
};

TEST_F(ForcedFolderTest, PointsComeBackAsTheyWere) {
    const auto points = run(false);
    const auto read = read_forced(path, scene);
    ASSERT_EQ(read.size(), 8U);
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].waves, points[i].waves);
        EXPECT_EQ(read[i].section, points[i].section);
        EXPECT_EQ(read[i].kind, points[i].kind);
        EXPECT_EQ(read[i].balance, points[i].balance);
    }
    const std::string table = file("response.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 9);
    EXPECT_THAT(table, HasSubstr("\nup,0.99,0.2475,"));
    EXPECT_THAT(file("balance.csv"), HasSubstr("mode,frequency_ratio,"));
    EXPECT_THAT(file("forced.txt"), HasSubstr("frequencies                                    8\n"));
    // Again from the records: to the byte.
    std::filesystem::remove(path / "response.csv");
    write_forced(path, scene, read);
    EXPECT_EQ(file("response.csv"), table);
    EXPECT_EQ(forced_charts(scene, read).front().data, forced_charts(scene, points).front().data);
}

TEST_F(ForcedFolderTest, AnInterruptedRunGoesOnToTheSameBytes) {
    run(false);
    const std::string whole = file(forced_records_name);
    std::filesystem::remove(path / forced_records_name);
    run(false, 3);
    const auto part = path / (std::string(forced_records_name) + ".part");
    ASSERT_TRUE(std::filesystem::exists(part));
    std::filesystem::resize_file(part, std::filesystem::file_size(part) - 7);  // the last line is torn
    {
        const ForcedFolder folder(path, scene, true);
        EXPECT_EQ(folder.known().size(), 2U);
    }
    run(true);
    EXPECT_EQ(file(forced_records_name), whole);
    EXPECT_FALSE(std::filesystem::exists(part));
}

TEST_F(ForcedFolderTest, WhatIsDamagedIsRefused) {
    run(false);
    const std::string whole = file(forced_records_name);
    const auto expect_damaged = [&](const std::string& text) {
        sample::write(path / forced_records_name, text);
        EXPECT_THAT(error_of([&] { (void)read_forced(path, scene); }), HasSubstr("is damaged: line 1"));
    };
    expect_damaged("nonsense\n" + whole);
    expect_damaged("{}\n" + whole);
    std::string other = whole;
    other.replace(other.find("\"frequency\":0.99"), 16, "\"frequency\":0.98");
    expect_damaged(other);
    std::string fewer = whole;
    const auto waves = fewer.find("\"waves\":[") + 9;
    fewer.erase(waves, fewer.find(',', waves) + 1 - waves);
    expect_damaged(fewer);
    std::string kind = whole;
    kind.replace(kind.find("\"kind\":\"") + 8, 3, "foo");
    expect_damaged(kind);
}

TEST(ForcingOfAScene, IsReadInEitherUnit) {
    Scene scene = parse_scene(scene_text(forcing), "test");
    ASSERT_TRUE(scene.forcing);
    EXPECT_EQ(scene.damping.kind, Damping::Kind::tip);
    EXPECT_EQ(scene.damping.value, 0.02);
    EXPECT_EQ(scene.forcing->frequencies.size(), 4U);
    EXPECT_EQ(scene.forcing->frequencies.front(), 0.99);
    EXPECT_EQ(scene.forcing->frequencies.back(), 1.08);
    EXPECT_TRUE(scene.forcing->up && scene.forcing->down && !scene.forcing->from_rest);
    // f_1 = c/4L = 0.25 Hz.
    scene = parse_scene(
        scene_text("[forcing]\namplitude = 1\nat = \"tip\"\nshape = \"cosine\"\nunit = \"Hz\"\nfrom = 0.25\nto = "
                   "0.5\ncount = 3\ndirection = \"down\"\nsettle = 0\nrecord = 2\nstart = \"rest\"\n"),
        "test");
    EXPECT_EQ(scene.forcing->frequencies, (std::vector<double>{1.0, 1.5, 2.0}));
    EXPECT_TRUE(!scene.forcing->up && scene.forcing->down && scene.forcing->from_rest);
    EXPECT_FALSE(parse_scene(sample::scene_text, "test").forcing);
}

TEST(ForcingOfAScene, IsRefusedInOneLine) {
    const auto refused = [](const std::string& from, const std::string& to, const std::string& said) {
        std::string text = scene_text(forcing);
        text.replace(text.find(from), from.size(), to);
        EXPECT_THAT(error_of([&] { (void)parse_scene(text, "test"); }), HasSubstr(said)) << to;
    };
    refused("amplitude = 0.05", "amplitude = -1", "forcing.amplitude: expected");
    refused("amplitude = 0.05\n", "",
            "forcing.amplitude: expected a finite number > 0, got nothing: the key is missing");
    refused("to = 1.08", "to = 0.5", "forcing.to: expected a number >= forcing.from");
    refused("to = 1.08", "to = 1e9", "forcing.to: expected 0.001 to 1000 omega_1");
    refused("to = 1.08", "to = 11",
            "forcing.to: expected at most 10 omega_1 on 20 cells: a period needs 8 steps, got 11 omega_1");
    refused("amplitude = 0.05", "amplitude = 1e200", "forcing.amplitude: expected a number from 1e-09 to 1e+09");
    refused("count = 4", "count = 1", "forcing.count: expected at least 2, since from < to");
    refused("count = 4", "count = 4\nat = \"middle\"", "forcing.at: expected one of tip, got \"middle\"");
    refused("count = 4", "count = 4\nunit = \"rad/s\"", "forcing.unit: expected one of omega_1, Hz");
    refused("count = 4", "count = 4\ndirections = \"up\"", "did you mean direction?");
    refused("record = 10", "record = 10000000", "forcing.record: expected at most");
    refused("count = 4", "count = 100000\nstart = \"rest\"", "no error");
    refused("count = 4\nsettle = 20\nrecord = 10", "count = 100000\nsettle = 20\nrecord = 1000",
            "forcing.count: expected at most 24510 frequencies");
    refused("record = 10", "record = 1", "forcing.record: expected an integer from 2");
    refused("kind = \"tip\"", "kind = \"none\"", "damping.kind: expected \"tip\" or \"distributed\"");
    refused("value = 0.02", "value = 0", "damping.value: expected");
}

// One frequency alone, a bar that never leaves the wall, one that is never driven to it: each chart has something to
// show.
TEST_F(ForcedFolderTest, EveryChartCanBeDrawn) {
    const auto draw = [&](const std::string& from, const std::string& to, double gap) {
        std::string text = scene_text(forcing);
        text.replace(text.find(from), from.size(), to);
        Scene one = parse_scene(text, "test");
        one.bar.gap = gap;
        const auto points = forced_response(one, {}, [](const ForcedPoint&) {});
        try {
            EXPECT_GT(draw_charts(forced_charts(one, points), path / "charts", {.formats = {"svg"}}).size(), 0U)
                << to << gap;
        } catch (const NoGnuplot&) {
        }
    };
    for (const double gap : {1.0, -1.0, 0.0, 100.0}) {
        draw("count = 4", "count = 4", gap);
        draw("to = 1.08\ncount = 4", "to = 0.99\ncount = 1", gap);
    }
}

TEST_F(ForcedFolderTest, AStateIsReadOrRefusedWithItsLine) {
    const auto state_of = [&](const std::string& text) {
        sample::write(path / "state.csv", text);
        return read_state(path / "state.csv", Mesh{2});
    };
    const State state = state_of("stress_pa,velocity_m_s\n1,2\r\n-3e-1,4\n");
    EXPECT_EQ(state, (State(4) << 1.0, -0.3, 2.0, 4.0).finished());
    const auto said = [&](const std::string& text) { return error_of([&] { (void)state_of(text); }); };
    EXPECT_THAT(said(""), HasSubstr("expected the line stress_pa,velocity_m_s, got none"));
    EXPECT_THAT(said("1,2\n"), HasSubstr("state.csv:1: expected the line"));
    EXPECT_THAT(said("stress_pa,velocity_m_s\n1,2\n"), HasSubstr("expected 2 cells, got 1"));
    EXPECT_THAT(said("stress_pa,velocity_m_s\n1,2\n3,4\n5,6\n"), HasSubstr("expected 2 cells, got more lines"));
    for (const char* line : {"1", "1,", ",1", "1,nan", "inf,1", "1,2,3", "1;2", "1,2x"})
        EXPECT_THAT(said(std::string("stress_pa,velocity_m_s\n") + line + "\n3,4\n"),
                    HasSubstr("state.csv:2: expected two finite numbers with a comma between"))
            << line;
}

}  // namespace
