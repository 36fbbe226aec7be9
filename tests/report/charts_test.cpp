#include "report/sweep/sweep_charts.hpp"

#include <cstdlib>

#include <gmock/gmock.h>

#include "sample.hpp"
#include "nsma/report/scene_file.hpp"

namespace nsma {
namespace {

using sample::error_of;
using testing::HasSubstr;
using testing::Not;

class ChartsTest : public sample::Folder {
protected:
    void sweep(const std::string& text = sample::scene_text) {
        const Scene scene = parse_scene(text, "sample");
        sample::store(path, scene, sample::results_of(scene));
    }
    [[nodiscard]] std::string chart(const char* name) const { return sample::read(path / "charts" / name); }
};

TEST_F(ChartsTest, EveryChartHasDataScriptAndPictures) {
    sweep();
    const DrawnCharts drawn = draw_sweep(path);
    EXPECT_EQ(drawn.pictures.size(), 6U);
    EXPECT_TRUE(drawn.skipped.empty());
    for (const char* name : {"frequency-energy", "orbits", "space-time"}) {
        for (const char* end : {".dat", ".gp", ".svg", ".png"}) {
            EXPECT_GT(chart((std::string(name) + end).c_str()).size(), 500U) << name << end;
        }
        // The script can be run again from its own folder: no path in it.
        EXPECT_THAT(chart((std::string(name) + ".gp").c_str()), Not(HasSubstr(path.string())));
    }
    EXPECT_EQ(chart("orbits.png").substr(1, 3), "PNG");
    EXPECT_THAT(chart("frequency-energy.svg"), HasSubstr("energy E/E"));
    EXPECT_THAT(chart("frequency-energy.svg"), HasSubstr("frequency"));
    EXPECT_THAT(chart("orbits.svg"), HasSubstr("tip displacement x/|d|"));
    EXPECT_THAT(chart("orbits.svg"), HasSubstr("contact force λ (N)"));
    EXPECT_THAT(chart("orbits.svg"), HasSubstr("wall, x = d"));
    EXPECT_THAT(chart("space-time.svg"), HasSubstr("stress σ (Pa)"));
    EXPECT_THAT(chart("space-time.svg"), HasSubstr("position s/L"));
}

TEST_F(ChartsTest, ChoosesThreeSeparateEnergiesOfTheFirstMode) {
    sweep();
    const StoredSweep sweep = read_sweep_folder(path);
    const OrbitChoice choice = choose_orbits(sweep);
    ASSERT_EQ(choice.orbits.size(), 3U);
    EXPECT_EQ(choice.what, "orbits of mode k = 1");
    EXPECT_GT(choice.orbits[1]->energy, 2.0 * choice.orbits[0]->energy);
    EXPECT_GT(choice.orbits[2]->energy, 2.0 * choice.orbits[1]->energy);
}

TEST_F(ChartsTest, BackboneDataPassThroughTheOrbits) {
    sweep();
    const StoredSweep sweep = read_sweep_folder(path);
    const Chart chart = frequency_energy_chart(sweep);
    // Every curve point satisfies the closed form; 1e-9: frequencies are printed in full.
    std::istringstream lines(chart.data.substr(chart.data.find("# exact-modes")));
    int points = 0;
    std::string line;
    std::getline(lines, line);
    for (double energy = 0, frequency = 0; std::getline(lines, line) && !line.empty(); ++points) {
        std::istringstream(line) >> energy >> frequency;
        EXPECT_NEAR(backbone_energy_ratio(1, 4.0 / frequency) / energy, 1.0, 1e-9);
    }
    EXPECT_GT(points, 100);
}

TEST_F(ChartsTest, SpaceTimePictureAgreesWithTheField) {
    sweep();
    const StoredSweep sweep = read_sweep_folder(path);
    const StoredOrbit& stored = *choose_orbits(sweep).orbits[1];
    const Eigen::MatrixXd stress = field(stored.orbit).stress;
    std::istringstream lines(space_time_chart(sweep.scene, stored).data);
    std::string line;
    std::getline(lines, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line)) {
        std::istringstream numbers(line);
        rows.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
    }
    // Just after a step every sample in a cell has that cell's stress.
    const auto steps = static_cast<std::size_t>(stress.cols());
    const std::size_t samples = rows.front().size() / 20;
    for (std::size_t n = 0; n < steps; n += 7) {
        const std::size_t row = (n * rows.size() + steps - 1) / steps;
        for (Eigen::Index cell = 0; cell < 20; ++cell) {
            const std::size_t column = static_cast<std::size_t>(cell) * samples + samples / 2;
            EXPECT_NEAR(rows[row][column], stress(cell, static_cast<Eigen::Index>(n)), 1e-3)
                << "step " << n << " cell " << cell;
        }
    }
}

TEST_F(ChartsTest, WithoutOrbitsOnlyTheDiagramIsDrawn) {
    const Scene scene = parse_scene(sample::scene_text, "sample");
    PatternRecord record;
    record.pattern = {20, 3, 4};
    record.verdict = Verdict::inadmissible;
    sample::store(path, scene, {{0, -1, record, std::nullopt}});
    const DrawnCharts drawn = draw_sweep(path);
    EXPECT_EQ(drawn.pictures.size(), 2U);
    EXPECT_EQ(drawn.skipped.size(), 2U);
}

TEST_F(ChartsTest, TitlesCannotBreakTheScript) {
    std::string text = sample::scene_text;
    text.replace(text.find("A sample"), 8, "It's 50% {x}_y $z `ls` \\\\ plot # µ");
    sweep(text);
    EXPECT_EQ(error_of([this] { (void)draw_sweep(path); }), "no error");
    EXPECT_THAT(chart("frequency-energy.svg"), HasSubstr("It's 50% {x}_y $z `ls`"));
}

TEST_F(ChartsTest, AFailingGnuplotIsOneLine) {
    const std::string message = error_of([this] {
        draw_chart({"bad", "1 2\n", "plot 'nothing here'\n"}, path / "charts");
    });
    EXPECT_THAT(message, HasSubstr("bad.gp: gnuplot failed: "));
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(ChartsTest, AMissingGnuplotIsOneLine) {
    const std::string before = std::getenv("PATH");
    setenv("PATH", path.c_str(), 1);
    const std::string message = error_of([this] { draw_chart({"any", "1 2\n", "plot 'any.dat'\n"}, path / "charts"); });
    setenv("PATH", before.c_str(), 1);
    EXPECT_THAT(message, HasSubstr("install gnuplot-nox"));
}

TEST(ScaledUnit, PicksTheReadablePrefix) {
    EXPECT_EQ(scaled_unit(2.1e9, "Pa").unit, "GPa");
    EXPECT_EQ(scaled_unit(4.7e7, "Pa").unit, "MPa");
    EXPECT_DOUBLE_EQ(scaled_unit(4.7e7, "Pa").factor, 1e-6);
    EXPECT_EQ(scaled_unit(5.0, "N").unit, "N");
    EXPECT_EQ(scaled_unit(0.3, "m").unit, "m");
    EXPECT_EQ(scaled_unit(0.03, "m").unit, "mm");
    EXPECT_EQ(scaled_unit(0.0, "m").unit, "m");
}

}  // namespace
}  // namespace nsma
