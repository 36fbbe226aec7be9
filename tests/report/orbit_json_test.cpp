#include "nsma/report/orbit_json.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sample.hpp"

namespace nsma {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;
}

OrbitAnswer answer_of(const Bar& bar) {
    OrbitAnswer answer = sample::least_energy_answer(bar, {20, 48, 16});
    answer.solvers = {{"ipopt", 0, "Solve_Succeeded", true, 1.5, 1e-12, 7, 0.01},
                      {"nlopt-slsqp", 1, "FAILURE", false, std::nan(""), std::nan(""), 9, 0.02}};
    return answer;
}

TEST(OrbitJson, ZerosHaveNoSign) {
    OrbitAnswer answer = answer_of(Bar{});
    answer.objective_value = -0.0;
    answer.orbit->beta *= -0.0;
    EXPECT_EQ(orbit_json(answer, Bar{}).find("-0.0"), std::string::npos);
}

TEST(OrbitJson, HasEveryAgreedField) {
    const Json json = Json::parse(orbit_json(answer_of(Bar{}), Bar{}));
    for (const char* key : {"cells",
                            "gap",
                            "free_steps",
                            "contact_steps",
                            "kernel_dimension",
                            "frequency_ratio",
                            "period_s",
                            "verdict",
                            "energy_ratio",
                            "energy_ratio_min",
                            "energy_ratio_max",
                            "energy_joule",
                            "frequency_hz",
                            "peak_force_n",
                            "impact_speed_m_s",
                            "peak_stress_pa",
                            "tip_min_m",
                            "objective",
                            "alpha",
                            "violations",
                            "solvers",
                            "agreement",
                            "tip_displacement",
                            "contact_force",
                            "reason",
                            "method",
                            "level",
                            "proof",
                            "classification",
                            "verdict_proved",
                            "energy_min_exact",
                            "energy_max_exact",
                            "energy_bound",
                            "optimality",
                            "kind",
                            "forceless",
                            "same_motion_as"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_EQ(json.size(), 37U);
    EXPECT_THAT(keys(json["objective"]), testing::ElementsAre("name", "value"));
    EXPECT_THAT(keys(json["violations"]), testing::ElementsAre("periodicity", "cond1", "cond2", "cond3", "energy"));
    EXPECT_THAT(keys(json["solvers"][0]), testing::UnorderedElementsAre("name", "start", "status", "objective",
                                                                        "violation", "iterations", "seconds"));
    EXPECT_EQ(json["tip_displacement"].size(), 65U);
    EXPECT_EQ(json["contact_force"].size(), 64U);
    EXPECT_EQ(json["alpha"].size(), json["kernel_dimension"].get<std::size_t>());
    EXPECT_DOUBLE_EQ(json["energy_ratio"].get<double>(), 25.0);
    EXPECT_DOUBLE_EQ(json["energy_joule"].get<double>(), 12.5);  // E_g = 1/2 J
    EXPECT_DOUBLE_EQ(json["frequency_ratio"].get<double>(), 1.25);
}

TEST(OrbitJson, NeverWritesNan) {
    OrbitAnswer answer = answer_of(Bar{});
    answer.objective_value = std::nan("");
    answer.objective_difference = std::numeric_limits<double>::infinity();
    answer.replay->violations.cond3 = std::nan("");
    answer.interval.unbounded = true;
    const Json json = Json::parse(orbit_json(answer, Bar{}));
    EXPECT_TRUE(json["objective"]["value"].is_null());
    EXPECT_TRUE(json["violations"]["cond3"].is_null());
    EXPECT_TRUE(json["energy_ratio_max"].is_null());
    EXPECT_TRUE(json["solvers"][1]["objective"].is_null());
    EXPECT_TRUE(json["solvers"][1]["violation"].is_null());
}

TEST(OrbitJson, AnswersWithoutAnOrbitKeepTheFields) {
    OrbitAnswer answer;
    answer.pattern = {20, 48, 16};
    answer.verdict = Verdict::below;
    answer.level = 1.0;
    answer.reason = "level 1 < 25";
    const Json json = Json::parse(orbit_json(answer, Bar{}));
    EXPECT_EQ(json.size(), 37U);
    EXPECT_EQ(json["verdict"], "below");
    EXPECT_TRUE(json["energy_ratio"].is_null());
    EXPECT_TRUE(json["violations"]["periodicity"].is_null());
    EXPECT_TRUE(json["alpha"].empty());
}

TEST(OrbitJson, ALineForStoringHasNoTimesAndNoLineEnd) {
    const std::string line = orbit_json(answer_of(Bar{}), Bar{}, false, -1);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(line.find("seconds"), std::string::npos);
}

TEST(OrbitJson, UnitsAreSiExceptTheDisplacement) {
    Bar steel{1.0, 210e9, 7850.0, 1e-4, 1e-4};
    const Json unit = Json::parse(orbit_json(answer_of(Bar{}), Bar{}));
    const Json si = Json::parse(orbit_json(answer_of(steel), steel));
    // alpha = beta u/dt, force = f Y S u/L; 1e-12: a few roundings.
    const double speed = steel.gap / steel.travel_time();
    EXPECT_NEAR(si["alpha"][0].get<double>() / (unit["alpha"][0].get<double>() * speed), 1.0, 1e-12);
    EXPECT_NEAR(si["contact_force"][60].get<double>() / (unit["contact_force"][60].get<double>() * steel.force_unit()),
                1.0, 1e-12);
    EXPECT_NEAR(si["tip_displacement"][0].get<double>(), 1.0, 1e-12);
    EXPECT_NEAR(si["energy_joule"].get<double>() / (25.0 * steel.energy_unit()), 1.0, 1e-12);
}

TEST(OrbitJson, AClosedGapHasMetresAndNoRatios) {
    Bar bar;
    bar.gap = 0.0;
    OrbitAnswer answer;
    answer.pattern = {20, 40, 20};
    const Kernel kernel = exact_kernel(answer.pattern);
    answer.verdict = Verdict::admissible;
    answer.orbit = make_orbit(bar, kernel, Eigen::VectorXd::Constant(kernel.dimension(), 0.1));
    answer.energy = energy_ratio(*answer.orbit);
    const Json json = Json::parse(orbit_json(answer, bar));
    EXPECT_TRUE(json["energy_ratio"].is_null());
    EXPECT_DOUBLE_EQ(json["energy_joule"].get<double>(), *answer.energy);
    EXPECT_DOUBLE_EQ(json["tip_displacement"][1].get<double>(), tip_displacement(*answer.orbit)(1));
}

}  // namespace
}  // namespace nsma
