#include "nsma/report/scene_file.hpp"

#include <gmock/gmock.h>

#include "sample.hpp"

namespace nsma {
namespace {

using sample::error_of;
using testing::HasSubstr;

/// The sample scene with `from` replaced by `to`.
std::string with(const std::string& from, const std::string& to) {
    std::string text = sample::scene_text;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string with_levels(const std::string& levels) { return with("list = [4.5, 6.0]", levels); }
std::string with_patterns(const std::string& patterns) { return with("mode = 1", patterns); }

struct BadScene {
    const char* name;
    std::string text;
    std::vector<const char*> said;  // fragments of the message
};

class BadSceneTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneTest, IsRefusedInOneLine) {
    const std::string message = error_of([] { (void)parse_scene(GetParam().text, "a.toml"); });
    EXPECT_THAT(message, testing::StartsWith("a.toml"));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 400U) << message;
    for (const char* fragment : GetParam().said) EXPECT_THAT(message, HasSubstr(fragment));
}

const BadScene bad_scenes[] = {
    {"empty", "", {"empty file"}},
    {"blank", " \n\t\n", {"empty file"}},
    {"comment_only", "# nothing\n", {"title: expected", "missing"}},
    {"syntax", "title = \n[bar", {"a.toml:1:", "syntax error"}},
    {"twice", with("[mesh]", "[bar]\n[mesh]"), {"syntax error"}},
    {"no_title", with("title = \"A sample\"", ""), {"title: expected one line of text", "missing"}},
    {"empty_title", with("A sample", ""), {"a.toml:1: title: expected one line of text, got \"\""}},
    {"title_of_two_lines", with("A sample", "A\\nB"), {"title: expected one line of text"}},
    {"unknown_key", with("gap = 1.0", "gap = 1.0\ncolour = 3"), {"a.toml:8: bar.colour", "unknown"}},
    {"table_is_a_number",
     with("[mesh]\ncells = 20", "").insert(0, "mesh = 20\n"),
     {"a.toml:1: mesh: expected a table"}},
    {"unknown_table", with("[mesh]", "[rod]\n[mesh]"), {"a.toml:8: rod", "unknown"}},
    {"missing_table", with("[mesh]\ncells = 20", ""), {"mesh: expected a table", "missing"}},
    {"missing_gap", with("gap = 1.0", ""), {"a.toml:2: bar.gap: expected", "missing"}},
    {"negative_length",
     with("length = 1.0", "length = -1.0"),
     {"a.toml:3: bar.length: expected a finite number > 0, got -1"}},
    {"zero_area", with("area = 1.0", "area = 0"), {"a.toml:6: bar.area", "> 0, got 0"}},
    {"nan_density", with("density = 1.0", "density = nan"), {"a.toml:5: bar.density", "got nan"}},
    {"infinite_gap", with("gap = 1.0", "gap = -inf"), {"a.toml:7: bar.gap", "got -inf"}},
    {"text_for_number", with("length = 1.0", "length = \"1\""), {"bar.length", "got \"1\""}},
    {"list_for_number", with("length = 1.0", "length = [1.0]"), {"bar.length", "a list of 1 values"}},
    {"true_for_number", with("length = 1.0", "length = true"), {"bar.length", "got true"}},
    {"underflow", with("gap = 1.0", "gap = 1e-200"), {"a.toml:7: bar.gap: expected 0 or a size from", "1e-200"}},
    {"no_number", with("gap = 1.0", "gap = -0.01e-400"), {"a.toml:7: bar.gap", "too small for a number"}},
    {"large_modulus", with("young_modulus = 1.0", "young_modulus = 1e60"), {"a.toml:4: bar.young_modulus", "1e+60"}},
    {"small_area", with("area = 1.0", "area = 1e-60"), {"a.toml:6: bar.area", "got 1e-60"}},
    {"level_huge", with_levels("list = [1e200]"), {"a.toml:13: levels.list: expected a number from 1e-30 to 1e+30"}},
    {"level_tiny",
     with_levels("from = 1e-200\nto = 1e200\ncount = 3\nspacing = \"log\""),
     {"levels.from: expected a number from 1e-30"}},
    {"long_key", with("gap = 1.0", "gap = 1.0\n" + std::string(5000, 'k') + " = 1"), {"bar.kkk", "...: expected one"}},
    {"deep_key", with("gap = 1.0", "gap" + std::string(16, '.') + " = 1.0"), {"a.toml:7: expected brackets and keys"}},
    // Text of several lines may end with five marks: two of them are its own.
    {"deep_behind_text",
     with("gap = 1.0", "gap = 1.0\nx = [\"\"\"x\"\"\"\", {a" + std::string(100'000, '.') + "=1}]"),
     {"a.toml:8: expected brackets and keys"}},
    {"deep_behind_literal",
     with("gap = 1.0", "gap = 1.0\nx = ['''x''''', {a" + std::string(100'000, '.') + "=1}]"),
     {"a.toml:8: expected brackets and keys"}},
    {"deep_list", with_levels("list = " + std::string(40'000, '[')), {"a.toml:13: expected brackets and keys"}},
    {"deep_table", with("gap = 1.0", "gap = " + std::string(40'000, '{')), {"a.toml:7: expected brackets and keys"}},
    {"no_cells", with("cells = 20", "cells = 0"), {"a.toml:9: mesh.cells: expected an integer", "got 0"}},
    {"half_cells", with("cells = 20", "cells = 2.5"), {"mesh.cells", "an integer", "got 2.5"}},
    {"too_many_cells", with("cells = 20", "cells = 1000001"), {"mesh.cells", "1000000"}},
    {"mode_zero", with_patterns("mode = 0"), {"a.toml:11: patterns.mode", "got 0"}},
    {"no_patterns", with_patterns(""), {"a.toml:10: patterns: expected exactly one of", "none"}},
    {"two_patterns", with_patterns("mode = 1\nperiod = [0, 4]"), {"exactly one of", "2 of them"}},
    {"period_reversed", with_patterns("period = [4.0, 1.0]"), {"a.toml:11: patterns.period", "[4, 1]"}},
    {"period_negative", with_patterns("period = [-1.0, 1.0]"), {"patterns.period", "got -1"}},
    {"period_of_three", with_patterns("period = [1, 2, 3]"), {"patterns.period", "a list of 3 values"}},
    {"period_huge", with_patterns("period = [0, 1e9]"), {"patterns.period", "10000000"}},
    {"contact_alone", with_patterns("mode = 1\ncontact = [0, 1]"), {"patterns.contact"}},
    {"contact_reversed", with_patterns("period = [0, 4]\ncontact = [2, 1]"), {"patterns.contact", "[2, 1]"}},
    {"list_empty", with_patterns("list = []"), {"patterns.list", "a list of 0 values"}},
    {"list_of_numbers", with_patterns("list = [3, 4]"), {"patterns.list", "got 3"}},
    {"list_row_of_one", with_patterns("list = [[3]]"), {"patterns.list", "two positive integers"}},
    {"list_zero", with_patterns("list = [[3, 0]]"), {"patterns.list", "got 0"}},
    {"list_real", with_patterns("list = [[3, 1.5]]"), {"patterns.list", "got 1.5"}},
    {"list_huge", with_patterns("list = [[9999999, 99]]"), {"patterns.list", "9999999 + 99"}},
    {"levels_missing", with_levels(""), {"a.toml:12: levels: expected either list or", "neither"}},
    {"levels_both", with_levels("list = [2.0]\nfrom = 1.0"), {"levels: expected either", "both"}},
    {"levels_empty", with_levels("list = []"), {"levels.list", "a list of 0 values"}},
    {"levels_negative", with_levels("list = [2.0, -3.0]"), {"levels.list", "> 0, got -3"}},
    {"levels_nan", with_levels("list = [nan]"), {"levels.list", "got nan"}},
    {"levels_no_spacing", with_levels("from = 1\nto = 2\ncount = 3"), {"levels.spacing", "missing"}},
    {"levels_no_to", with_levels("from = 1\ncount = 3\nspacing = \"log\""), {"levels.to", "missing"}},
    {"levels_count_0",
     with_levels("from = 1\nto = 2\ncount = 0\nspacing = \"log\""),
     {"a.toml:15: levels.count", "got 0"}},
    {"levels_count_1",
     with_levels("from = 1\nto = 2\ncount = 1\nspacing = \"log\""),
     {"levels.count: expected at least 2", "got 1"}},
    {"levels_same_twice",
     with_levels("from = 2\nto = 2\ncount = 3\nspacing = \"log\""),
     {"levels.count: expected 1", "got 3"}},
    {"levels_reversed",
     with_levels("from = 3\nto = 2\ncount = 3\nspacing = \"log\""),
     {"levels.to: expected a number >= levels.from = 3, got 2"}},
    {"levels_from_zero", with_levels("from = 0\nto = 2\ncount = 3\nspacing = \"log\""), {"levels.from", "> 0, got 0"}},
    {"spacing_unknown",
     with_levels("from = 1\nto = 2\ncount = 3\nspacing = \"cubic\""),
     {"a.toml:16: levels.spacing", "got \"cubic\""}},
    {"objective_unknown",
     with("least-shock", "least-noise"),
     {"program.objective", "\"least-shock\"", "got \"least-noise\""}},
    {"objective_number", with("\"least-shock\"", "3"), {"program.objective", "got 3"}},
};

INSTANTIATE_TEST_SUITE_P(SceneFile, BadSceneTest, testing::ValuesIn(bad_scenes),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

TEST(SceneFile, ReadsTheSample) {
    const Scene scene = parse_scene(sample::scene_text, "sample");
    EXPECT_EQ(scene.title, "A sample");
    EXPECT_EQ(scene.mesh.cells, 20);
    EXPECT_EQ(std::get<ModeSelection>(scene.patterns).mode, 1);
    EXPECT_EQ(scene.levels, (std::vector<double>{4.5, 6.0}));
    EXPECT_EQ(scene.objective, Objective::least_shock);
    EXPECT_EQ(scene.text, sample::scene_text);
}

TEST(SceneFile, TakesIntegersForNumbersAndInlineTables) {
    const Scene scene = parse_scene(with("length = 1.0", "length = 2"), "sample");
    EXPECT_EQ(scene.bar.length, 2.0);
    const Scene period = parse_scene(with_patterns("period = [0, 4]\ncontact = [0.5, 1]"), "sample");
    EXPECT_EQ(std::get<PeriodSelection>(period.patterns).contact->at(1), 1.0);
    const Scene list = parse_scene(with_patterns("list = [[48, 16], [3, 4]]"), "sample");
    EXPECT_EQ(std::get<ListSelection>(list.patterns).steps.front(), std::pair(48, 16));
}

TEST(SceneFile, LevelsKeepTheirEndsExactly) {
    const Scene scene = parse_scene(with_levels("from = 1.05\nto = 100.1\ncount = 12\nspacing = \"log\""), "sample");
    ASSERT_EQ(scene.levels.size(), 12U);
    EXPECT_EQ(scene.levels.front(), 1.05);
    EXPECT_EQ(scene.levels.back(), 100.1);
    EXPECT_TRUE(std::is_sorted(scene.levels.begin(), scene.levels.end()));
    const Scene linear = parse_scene(with_levels("from = 1\nto = 3\ncount = 3\nspacing = \"linear\""), "sample");
    EXPECT_EQ(linear.levels, (std::vector<double>{1.0, 2.0, 3.0}));
    const Scene one = parse_scene(with_levels("from = 2\nto = 2\ncount = 1\nspacing = \"log\""), "sample");
    EXPECT_EQ(one.levels, (std::vector<double>{2.0}));
}

TEST(SceneFile, ReadsEveryProblem) {
    int read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(NSMA_PROBLEMS)) {
        if (entry.path().extension() != ".toml") continue;
        EXPECT_EQ(error_of([&] { (void)read_scene(entry.path()); }), "no error");
        ++read;
    }
    EXPECT_GE(read, 7);
}

TEST(SceneFile, UnreadableFilesAreNamed) {
    EXPECT_THAT(error_of([] { (void)read_scene("/no/such.toml"); }),
                HasSubstr("/no/such.toml: expected a scene file, got an error: No such file"));
    EXPECT_THAT(error_of([] { (void)read_scene("/tmp"); }), HasSubstr("got a directory"));
    EXPECT_THAT(error_of([] { (void)read_scene("/dev/null"); }), HasSubstr("empty file"));
    EXPECT_THAT(error_of([] { (void)read_scene("/dev/zero"); }), HasSubstr("expected at most"));
}

}  // namespace
}  // namespace nsma
