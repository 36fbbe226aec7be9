#include "report/sensitivity/sensitivity_charts.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "nsma/report/scene_file.hpp"

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

nsma::SensitivityRecords study(const nsma::Scene& scene, const std::vector<double>& amounts = {0, 0.1, 0.3}) {
    nsma::SensitivityRequest request;
    request.solver.solvers = nsma::SolverChoice::nlopt;
    request.amounts = amounts;
    return nsma::sensitivity(scene, request, [] { return true; });
}

fs::path fresh(const char* name) {
    fs::path folder = fs::path(testing::TempDir()) / name;
    fs::remove_all(folder);
    return folder;
}

TEST(SensitivityFolder, EveryFileHasOneNumberOfFields) {
    const nsma::Scene two = scene();
    const auto found = study(two);
    const fs::path folder = fresh("sensitivity-files");
    nsma::open_sensitivity_folder(folder, two);
    nsma::write_sensitivity(folder, two, found);
    for (const char* file : nsma::sensitivity_files) {
        std::ifstream stream(folder / file);
        ASSERT_TRUE(stream) << file;
        if (std::string(file).find(".csv") == std::string::npos) continue;
        std::size_t fields = 0;
        int rows = 0;
        for (std::string line; std::getline(stream, line);) {
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

// Fields of a line of a table; no field that is read here holds a comma.
std::vector<std::map<std::string, std::string>> table_of(const std::string& text) {
    std::vector<std::map<std::string, std::string>> rows;
    std::vector<std::string> names;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        std::vector<std::string> fields;
        std::istringstream words(line);
        for (std::string word; std::getline(words, word, ',');) fields.push_back(word);
        if (names.empty()) {
            names = fields;
            continue;
        }
        auto& row = rows.emplace_back();
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = i < fields.size() ? fields[i] : "";
    }
    return rows;
}

// The steel rod in SI units and the bar of units: the same elasticities, and each again from the
// columns in SI.
TEST(SensitivityFolder, ElasticitiesDoNotDependOnUnits) {
    const fs::path problems = NSMA_PROBLEMS;
    nsma::Scene unit = nsma::read_scene(problems / "first-mode.toml");
    nsma::Scene steel = nsma::read_scene(problems / "steel-rod.toml");
#if defined(__SANITIZE_ADDRESS__)
    unit.mesh.cells = steel.mesh.cells = 6;
#endif
    unit.levels = steel.levels = {3.0, 12.6};
    const auto prices = [](const nsma::Scene& scene) {
        const auto found = study(scene, {});
        return table_of(nsma::sensitivity_text("prices.csv", scene, found));
    };
    const auto one = prices(unit);
    const auto other = prices(steel);
    ASSERT_EQ(one.size(), other.size());
    int compared = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const auto& a = one[i];
        const auto& b = other[i];
        ASSERT_EQ(a.at("kind"), b.at("kind")) << i;
        for (const char* side : {"right", "left"}) {
            const std::string& elasticity = a.at(std::string("elasticity_") + side);
            ASSERT_EQ(elasticity.empty(), b.at(std::string("elasticity_") + side).empty());
            if (elasticity.empty()) continue;
            const double expected = std::stod(elasticity);
            const double tolerance = 1e-10 * (1 + std::abs(expected));
            EXPECT_NEAR(std::stod(b.at(std::string("elasticity_") + side)), expected, tolerance) << i;
            const std::string& parameter = b.at("parameter");
            const nsma::Bar& bar = steel.bar;
            const double energy_unit = bar.young_modulus * bar.area * bar.gap * bar.gap / (2 * bar.length);
            const double amount = b.at("parameter_unit") == "N" ? bar.young_modulus * bar.area * bar.gap / bar.length
                                  : parameter == "energy"       ? std::stod(b.at("level")) * energy_unit
                                                                : bar.gap;
            const double objective = std::stod(b.at("objective_value")) * energy_unit;
            EXPECT_NEAR(std::stod(b.at(std::string(side) + "_si")) * amount / objective, expected, tolerance) << i;
            ++compared;
        }
    }
    EXPECT_GT(compared, 100);
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
    const auto funnels = nsma::funnels(study(two).ablations);
    ASSERT_EQ(funnels.size(), 6U);
    for (const auto& funnel : funnels) {
        EXPECT_EQ(funnel.left[0], funnels.front().left[0]);
        EXPECT_EQ(funnel.left[3], 2);  // (16, 4) and (23, 1) are admissible
        for (std::size_t i = 1; i < 4; ++i) EXPECT_LE(funnel.left[i], funnel.left[i - 1]);
    }
}

TEST(SensitivityFolder, DrawsNoChartWhoseCurvesCoincide) {
    nsma::SensitivityRecords records;
    const auto names = [&] {
        std::string text;
        for (const nsma::Chart& chart : nsma::sensitivity_charts(scene(), records)) text += chart.name + ' ';
        return text;
    };
    nsma::AblationRecord admitted;
    admitted.survives.fill(true);
    nsma::CurveRecord point;
    point.relaxed = "band";
    records.ablations = {admitted, admitted};
    records.curves = {point};
    EXPECT_EQ(names(), "");
    records.ablations.front().survives.back() = false;
    EXPECT_EQ(names(), "funnel ");
    point.relaxed = "penetration";
    point.admissible = true;
    records.curves.push_back(point);
    EXPECT_EQ(names(), "counts funnel ");
}

TEST(SensitivityFolder, DrawsEveryChart) {
    const nsma::Scene two = scene();
    const auto found = study(two);
    const fs::path folder = fresh("sensitivity-charts");
    const auto pictures = nsma::draw_charts(nsma::sensitivity_charts(two, found), folder);
    EXPECT_EQ(pictures.size(), 6U);  // binding, relaxation, funnel; no relaxation changes what is admissible
    for (const auto& picture : pictures) EXPECT_GT(fs::file_size(picture), 1000U) << picture;
}

}  // namespace
