#include "report/sweep/sweep_charts.hpp"

#include <algorithm>
#include <cmath>
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
    // Draws all charts of the stored sweep.
    std::vector<std::filesystem::path> draw(const Drawing& drawing = {}) const {
        return draw_charts(sweep_charts(read_sweep_folder(path)), path / "charts", drawing);
    }
    [[nodiscard]] std::string chart(const char* name) const { return sample::read(path / "charts" / name); }
};

TEST_F(ChartsTest, EveryChartHasDataScriptAndPictures) {
    sweep();
    EXPECT_EQ(draw().size(), 8U);
    for (const char* name : {"overview", "frequency-energy", "orbits", "space-time"}) {
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
    EXPECT_THAT(chart("space-time.svg"), HasSubstr("stress σ, tension > 0 (Pa)"));
    EXPECT_THAT(chart("space-time.svg"), HasSubstr("velocity v, to the wall > 0 (m/s)"));
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
    const Chart chart = frequency_energy_chart(sweep, choose_orbits(sweep));
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

// Rows of numbers of one block of a chart's data.
std::vector<std::vector<double>> block(const Chart& chart, const std::string& name) {
    std::istringstream lines(chart.data.substr(chart.data.find("\n# " + name) + 1));
    std::string line;
    std::getline(lines, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line) && !line.empty()) {
        std::istringstream numbers(line);
        rows.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
    }
    return rows;
}

TEST_F(ChartsTest, SpaceTimePicturesAgreeWithTheFields) {
    sweep();
    const StoredSweep sweep = read_sweep_folder(path);
    const StoredOrbit& stored = *choose_orbits(sweep).orbits[1];
    const Field truth = field(stored.orbit);
    const Chart chart = space_time_chart(sweep.scene, stored, "space-time");
    // Just after a step every sample in a cell has that cell's stress and velocity.
    for (const auto& [name, cells] : {std::pair{"stress", &truth.stress}, std::pair{"velocity", &truth.velocity}}) {
        const auto rows = block(chart, name);
        const auto steps = static_cast<std::size_t>(cells->cols());
        const std::size_t samples = rows.front().size() / 20;
        for (std::size_t n = 0; n < steps; n += 7) {
            const std::size_t row = (n * rows.size() + steps - 1) / steps;
            for (Eigen::Index cell = 0; cell < 20; ++cell) {
                const std::size_t column = static_cast<std::size_t>(cell) * samples + samples / 2;
                EXPECT_NEAR(rows[row][column], (*cells)(cell, static_cast<Eigen::Index>(n)), 1e-3)  // as printed
                    << name << " step " << n << " cell " << cell;
            }
        }
    }
}

TEST_F(ChartsTest, MarksTheOrbitsThatItDraws) {
    sweep();
    const StoredSweep sweep = read_sweep_folder(path);
    const OrbitChoice choice = choose_orbits(sweep);
    for (const Chart& chart : {frequency_energy_chart(sweep, choice), overview_chart(sweep, choice)}) {
        const auto marks = block(chart, "orbits-drawn");
        ASSERT_EQ(marks.size(), choice.orbits.size());
        for (std::size_t i = 0; i < marks.size(); ++i) {
            EXPECT_NEAR(marks[i].at(0) / choice.orbits[i]->energy, 1.0, 1e-12);
            EXPECT_NEAR(marks[i].at(1), choice.orbits[i]->orbit.kernel.pattern.frequency_ratio(), 1e-12);
        }
    }
}

TEST_F(ChartsTest, ShowsTwoSolvedLevelsOfOnePatternAndAnotherOrbit) {
    const Scene scene = parse_scene(sample::scene_text, "sample");
    auto results = sample::results_of(scene);
    // Two answers at levels for one pattern: the orbit itself, called by other energies, is enough for the choice.
    const auto least = std::find_if(results.begin(), results.end(), [](const WorkResult& result) {
        return result.answer && result.answer->pattern == Pattern{20, 60, 10};
    });
    ASSERT_NE(least, results.end());
    const long number = least->pattern;
    OrbitAnswer answer = *least->answer;
    for (int place = 1; place <= 2; ++place) {
        const double level = scene.levels[static_cast<std::size_t>(place - 1)];
        answer.level = level;
        answer.energy = level;
        answer.orbit = make_orbit(scene.bar, answer.orbit->kernel,
                                  answer.orbit->beta * std::sqrt(level / energy_ratio(*answer.orbit)));
        results.push_back({number, place, std::nullopt, answer});
    }
    StoredSweep sweep{scene, {}, {}, {}};
    for (WorkResult& result : results) {
        if (result.answer)
            sweep.orbits.push_back({result.answer->level, *result.answer->energy, *result.answer->orbit});
    }
    const OrbitChoice choice = choose_orbits(sweep);
    ASSERT_EQ(choice.orbits.size(), 3U);
    int solved = 0;
    for (const StoredOrbit* orbit : choice.orbits) {
        solved += orbit->level ? 1 : 0;
        EXPECT_EQ(orbit->level.has_value(), orbit->orbit.kernel.pattern == (Pattern{20, 60, 10}));
    }
    EXPECT_EQ(solved, 2);
}

TEST_F(ChartsTest, OtherFormatsAndSizes) {
    sweep();
    const auto pictures = draw({.formats = {"pdf", "svg"}, .width = 500, .height = 400});
    ASSERT_EQ(pictures.size(), 8U);
    EXPECT_EQ(chart("overview.pdf").substr(0, 5), "%PDF-");
    EXPECT_THAT(chart("overview.pdf"), HasSubstr("0 0 500 400"));  // its box in points
    EXPECT_THAT(chart("overview.svg"), HasSubstr("viewBox=\"0 0 500 400\""));
    EXPECT_FALSE(std::filesystem::exists(path / "charts" / "overview.png"));
}

TEST_F(ChartsTest, WithoutOrbitsOnlyTheDiagramIsDrawn) {
    const Scene scene = parse_scene(sample::scene_text, "sample");
    PatternRecord record;
    record.pattern = {20, 3, 4};
    record.verdict = Verdict::inadmissible;
    sample::store(path, scene, {{0, -1, record, std::nullopt}});
    EXPECT_EQ(draw().size(), 2U);
}

TEST_F(ChartsTest, TitlesCannotBreakTheScript) {
    std::string text = sample::scene_text;
    text.replace(text.find("A sample"), 8, "It's 50% {x}_y $z `ls` \\\\ plot # µ");
    sweep(text);
    EXPECT_EQ(error_of([this] { (void)draw(); }), "no error");
    for (const char* name : {"frequency-energy.svg", "overview.svg", "orbits.svg", "space-time.svg"})
        EXPECT_THAT(chart(name), HasSubstr("It's 50% {x}_y $z `ls`")) << name;
}

TEST_F(ChartsTest, AFailingGnuplotIsOneLine) {
    const std::string message = error_of([this] {
        (void)draw_charts({{"bad", "1 2\n", "plot 'nothing here'\n"}}, path / "charts");
    });
    EXPECT_THAT(message, HasSubstr("bad.gp: gnuplot failed: "));
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(ChartsTest, AMissingGnuplotIsOneLine) {
    std::filesystem::create_directory(path / "charts");
    sample::write(path / "charts" / "any.svg", "of a run before");
    const std::string before = std::getenv("PATH");
    setenv("PATH", path.c_str(), 1);
    const std::string message = error_of([this] {
        (void)draw_charts({{"any", "1 2\n", "plot 'any.dat'\n"}}, path / "charts");
    });
    setenv("PATH", before.c_str(), 1);
    EXPECT_THAT(message, HasSubstr("install gnuplot-nox"));
    EXPECT_EQ(chart("any.svg"), "of a run before");
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
