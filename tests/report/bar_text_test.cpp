#include "report/bar_text.hpp"

#include <gmock/gmock.h>

#include "sample.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/did_you_mean.hpp"

namespace nsma {
namespace {

using sample::error_of;
using testing::HasSubstr;

Scene scene_with(const std::string& from, const std::string& to) {
    std::string text = sample::scene_text;
    return parse_scene(text.replace(text.find(from), from.size(), to), "sample");
}

TEST(BarText, DerivesWhatTheBarIs) {
    Scene scene = scene_with("A sample", "Steel");
    scene.bar = {1.0, 210e9, 7850.0, 1e-4, 1e-4};
    // c = sqrt(210e9/7850), tau = 1/c, f_1 = c/4, E_g = 210e9 1e-4 1e-8/2; n_T of mode 1 are 61..79 on 20 cells.
    EXPECT_EQ(
        derived_text(scene),
        "bar: c = 5.1722 km/s, tau = L/c = 193.34 µs, f_1 = c/4L = 1.293 kHz, E_g = 0.105 J, d/L = 0.0001; mode 1 "
        "has 19 frequencies on 20 cells");
    scene.bar.gap = 0;
    EXPECT_THAT(derived_text(scene), testing::Not(HasSubstr("E_g")));
}

TEST(BarText, AModeWithoutPatternsSaysWhichMeshHasOne) {
    Scene scene = scene_with("mode = 1", "mode = 7");
    scene.mesh.cells = 6;
    EXPECT_THAT(derived_text(scene),
                HasSubstr("mode 7 has 0 frequencies on 6 cells, 62 cells are the fewest with one"));
    // By search over all pairs of steps: r = 2(7 n - 2N), p = 4N - 13 n with 15 N/49 < n < 4N/13 and both at least one.
    for (int cells = 6; cells <= 62; ++cells) {
        bool any = false;
        for (int n = 1; n < 4 * cells; ++n)
            any = any || (49 * n > 15 * cells && 13 * n < 4 * cells && 2 * (7 * n - 2 * cells) >= 1);
        EXPECT_EQ(any, cells == 62) << cells;
    }
}

TEST(BarText, DoubtsWhatNoBarIs) {
    Scene scene = scene_with("A sample", "Rod");
    EXPECT_TRUE(doubts(scene).empty());  // the unit bar
    scene.bar = {1.0, 210e9, 7850.0, 1e-4, 1e-4};
    EXPECT_TRUE(doubts(scene).empty());
    scene.bar.young_modulus = 210;  // in GPa
    ASSERT_EQ(doubts(scene).size(), 1U);
    EXPECT_THAT(doubts(scene)[0], HasSubstr("wave speed"));
    scene.bar = {1.0, 210e9, 7850.0, 1e-4, 0.1};  // in mm
    ASSERT_EQ(doubts(scene).size(), 2U);
    EXPECT_THAT(doubts(scene)[0], HasSubstr("strain d/L = 10 %"));
    EXPECT_THAT(doubts(scene)[1], HasSubstr("stress Y d/L = 21 GPa"));
}

TEST(SceneLevels, InJoulesAreThoseOfTheBar) {
    // E_g = Y S d^2/(2 L) = 1/2 J for the unit bar.
    const Scene scene = scene_with("list = [4.5, 6.0]", "unit = \"J\"\nlist = [4.5, 6.0]");
    EXPECT_EQ(scene.levels, (std::vector<double>{9.0, 12.0}));
    const Scene ratio = scene_with("list = [4.5, 6.0]", "unit = \"E_g\"\nlist = [4.5, 6.0]");
    EXPECT_EQ(ratio.levels, (std::vector<double>{4.5, 6.0}));
    // A wider gap has a greater unit; the joules stay.
    const Scene wider = with_changes(scene, 12, 2.0, "sample");
    EXPECT_EQ(wider.levels, (std::vector<double>{2.25, 3.0}));
    EXPECT_EQ(wider.mesh.cells, 12);
    EXPECT_EQ(wider.bar.gap, 2.0);
    EXPECT_EQ(parse_scene(wider.text, "again").levels, wider.levels);
    EXPECT_EQ(with_changes(scene, std::nullopt, -0.5, "sample").bar.gap, -0.5);
    EXPECT_THAT(error_of([] { (void)scene_with("list = [4.5, 6.0]", "unit = \"kJ\"\nlist = [4.5, 6.0]"); }),
                HasSubstr("levels.unit: expected \"E_g\" or \"J\""));
    std::string closed = sample::scene_text;
    closed.replace(closed.find("gap = 1.0"), 9, "gap = 0.0");
    closed.replace(closed.find("[levels]"), 8, "[levels]\nunit = \"E_g\"");
    EXPECT_THAT(error_of([&] { (void)parse_scene(closed, "sample"); }), HasSubstr("a closed gap has no E_g"));
}

TEST(DidYouMean, NamesOneNearWord) {
    const std::vector<std::string> words{"scan", "sweep", "sensitivity", "gap"};
    EXPECT_EQ(did_you_mean("swep", words), ", did you mean sweep?");
    EXPECT_EQ(did_you_mean("gapp", words), ", did you mean gap?");
    EXPECT_EQ(did_you_mean("sensitvity", words), ", did you mean sensitivity?");
    EXPECT_EQ(did_you_mean("dance", words), "");
    EXPECT_EQ(did_you_mean("x", words), "");
    EXPECT_EQ(did_you_mean("", words), "");
    EXPECT_EQ(did_you_mean(std::string(5000, 'k'), words), "");
}

TEST(SceneFile, ATextWithoutQuotesIsNamed) {
    EXPECT_THAT(error_of([] { (void)scene_with("\"least-shock\"", "least-shock"); }),
                HasSubstr("a text stands in \"quotation marks\""));
}

}  // namespace
}  // namespace nsma
