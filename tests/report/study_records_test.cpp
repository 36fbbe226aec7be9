#include "report/study_records.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sample.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/accuracy/accuracy_folder.hpp"
#include "report/csv_metadata.hpp"
#include "report/orbit_folder.hpp"
#include "report/sensitivity/sensitivity_charts.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"

namespace nsma {
namespace {

using sample::error_of;
using testing::HasSubstr;

class StudyRecordsTest : public sample::Folder {
protected:
    void SetUp() override {
        Folder::SetUp();
        std::string text = sample::scene_text;
        text.replace(text.find("cells = 20"), 10, "cells = 6");
        sample::write(path / "scene.toml", text);
        scene = read_scene(path / "scene.toml");
    }
    void edit(const char* file, const std::string& from, const std::string& to) const {
        std::string text = sample::read(path / file);
        text.replace(text.find(from), from.size(), to);
        sample::write(path / file, text);
    }
    Scene scene;
};

TEST_F(StudyRecordsTest, ASensitivityStudyComesBackWhole) {
    SensitivityRequest request;
    request.solver.solvers = SolverChoice::nlopt;
    request.amounts = {0, 0.1};
    scene.objective = Objective::least_force;  // as from the command line
    const SensitivityRecords records = sensitivity(scene, request, [] { return true; });
    ASSERT_FALSE(records.optima.empty());
    write_sensitivity(path, scene, records);
    Scene again = read_scene(path / "scene.toml");
    const SensitivityRecords read = read_sensitivity_records(path, again);
    EXPECT_EQ(again.objective, Objective::least_force);
    for (const char* file : sensitivity_files)
        EXPECT_EQ(sensitivity_text(file, again, read), sensitivity_text(file, scene, records)) << file;
    const auto charts = sensitivity_charts(scene, records);
    const auto charts_again = sensitivity_charts(again, read);
    ASSERT_EQ(charts.size(), charts_again.size());
    for (std::size_t i = 0; i < charts.size(); ++i) {
        EXPECT_EQ(charts_again[i].data, charts[i].data);
        EXPECT_EQ(gnuplot_script(charts_again[i]), gnuplot_script(charts[i]));
    }
}

TEST_F(StudyRecordsTest, AnAccuracyStudyComesBackWithNumbersThatJsonHasNot) {
    AccuracyResults results;
    ProgramRecord program;
    program.pattern = {6, 16, 4};
    program.method = "SLSQP";
    program.runs = 3;
    program.outcomes[1] = 3;
    program.seconds = {1e-4, 0.1 + 0.2, 3e-4};
    program.worst_gap = std::numeric_limits<double>::infinity();
    program.error = std::numeric_limits<double>::quiet_NaN();
    results.programs = {program};
    results.drifts = {{5, "FE", "", 10, -std::numeric_limits<double>::quiet_NaN(), 0.0, 0.1}};
    results.marches = {{5, "wave queue", "", true, 16, {1e-6, 1e-6, 1e-6}, 0.0, 1.0 / 3.0}};
    write_records(path, results);
    const AccuracyResults read = read_accuracy_records(path);
    ASSERT_EQ(read.programs.size(), 1U);
    EXPECT_EQ(read.programs[0].pattern, program.pattern);
    EXPECT_EQ(read.programs[0].outcomes, program.outcomes);
    EXPECT_EQ(read.programs[0].seconds.low, 0.1 + 0.2);
    EXPECT_EQ(read.programs[0].worst_gap, program.worst_gap);
    EXPECT_TRUE(std::isnan(read.programs[0].error));
    EXPECT_TRUE(std::isnan(read.drifts.at(0).energy_drift));
    ASSERT_EQ(read.marches.size(), 1U);
    EXPECT_EQ(read.marches[0].contact_error, 1.0 / 3.0);
    EXPECT_TRUE(read.marches[0].decides_contact);
}

TEST_F(StudyRecordsTest, WhatIsDamagedOrElseIsRefused) {
    EXPECT_THAT(error_of([this] { (void)read_accuracy_records(path); }), HasSubstr("accuracy.json"));
    AccuracyResults results;
    results.drifts = {{5, "cell update", "", 10, 0.0, 0.0, 0.125}};
    write_records(path, results);
    const std::string whole = sample::read(path / accuracy_records_name);
    edit(accuracy_records_name, "0.125", "0.126");
    EXPECT_THAT(error_of([this] { (void)read_accuracy_records(path); }), HasSubstr("is damaged"));
    sample::write(path / accuracy_records_name, whole.substr(0, whole.size() / 2));
    EXPECT_THAT(error_of([this] { (void)read_accuracy_records(path); }), HasSubstr("got other text"));
    sample::write(path / accuracy_records_name, std::string(100'000, '['));
    EXPECT_THAT(error_of([this] { (void)read_accuracy_records(path); }), HasSubstr("nested too deep"));
    // The records of one study under the name of the other.
    sample::write(path / sensitivity_records_name, whole);
    EXPECT_THAT(error_of([this] { (void)read_sensitivity_records(path, scene); }), HasSubstr("got others"));
}

TEST_F(StudyRecordsTest, AnOrbitComesBackFromItsAmplitudes) {
    scene.bar = {.length = 0.5, .young_modulus = 70e9, .density = 2700, .area = 7.854e-5, .gap = 1e-4};
    std::string text = sample::scene_text;
    for (const auto& [from, to] :
         {std::pair{"length = 1.0", "length = 0.5"}, std::pair{"young_modulus = 1.0", "young_modulus = 70e9"},
          std::pair{"density = 1.0", "density = 2700.0"}, std::pair{"area = 1.0", "area = 7.854e-5"},
          std::pair{"gap = 1.0", "gap = 1e-4"}}) {
        text.replace(text.find(from), std::string(from).size(), to);
    }
    sample::write(path / "scene.toml", text);
    scene = read_scene(path / "scene.toml");
    const OrbitAnswer answer = sample::least_energy_answer(scene.bar, {20, 60, 10});
    write_orbit_folder(path, scene, answer);
    const auto [again, stored] = read_orbit_folder(path);
    EXPECT_EQ(stored.level, answer.level);
    EXPECT_NEAR(stored.energy / *answer.energy, 1.0, 1e-14);  // alpha = beta u/dt is rounded, once each way
    EXPECT_LT((stored.orbit.beta - answer.orbit->beta).norm() / answer.orbit->beta.norm(), 1e-14);
    const std::string curves = sample::read(path / "orbit-curves.csv");
    EXPECT_EQ(curves.substr(0, curves.find('\n')), "free_steps,contact_steps,level,t_s,x_m,force_n");
    const std::string whole = sample::read(path / orbit_json_name);
    auto json = nlohmann::json::parse(whole);
    json["alpha"][0] = 1.01 * json["alpha"][0].get<double>();
    sample::write(path / orbit_json_name, json.dump());
    EXPECT_THAT(error_of([this] { (void)read_orbit_folder(path); }), HasSubstr("not of this orbit"));
    for (const auto& cells : {nlohmann::json(1e300), nlohmann::json(4294967316), nlohmann::json(19)}) {
        json = nlohmann::json::parse(whole);
        json["cells"] = cells;
        sample::write(path / orbit_json_name, json.dump());
        EXPECT_THAT(error_of([this] { (void)read_orbit_folder(path); }), HasSubstr("orbit.json: expected the orbit"));
    }
    sample::write(path / orbit_json_name, whole);
    edit(orbit_json_name, "\"alpha\"", "\"beta\"");
    EXPECT_THAT(error_of([this] { (void)read_orbit_folder(path); }), HasSubstr("orbit.json: expected the orbit"));
}

TEST_F(StudyRecordsTest, TheTablesOfAFolderAreDescribed) {
    sample::write(path / "levels.csv", "gap,level,peak_force_n,impact_speed_m_s,contact_steps,kind\n");
    sample::write(path / "prices.csv", "parameter,right_si\n");
    write_csv_metadata(path, "It's \"a\" title\n");
    const auto json = nlohmann::json::parse(sample::read(path / csv_metadata_name));
    ASSERT_EQ(json["tables"].size(), 2U);
    EXPECT_EQ(json["dc:title"], "It's \"a\" title ");
    const auto& columns = json["tables"][0]["tableSchema"]["columns"];
    ASSERT_EQ(columns.size(), 6U);
    const std::vector<std::string> units{"m", "", "N", "m/s", "time steps", ""};
    for (std::size_t i = 0; i < units.size(); ++i)
        EXPECT_EQ(columns[i].value("schema:unitText", ""), units[i]) << columns[i];
}

}  // namespace
}  // namespace nsma
