// `nsma orbit`: one orbit as text and as JSON.
#include "program.hpp"

#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using process::contents;
using process::lines_of;

json parsed(const std::string& out) {
    EXPECT_EQ(out.find("nan"), std::string::npos);
    return json::parse(out);
}

/// The fields that `orbit --json` promises, with the right types, null where there is no value.
void expect_fields(const json& orbit) {
    const std::vector<std::string> promised{
        "cells",        "gap",     "free_steps",   "contact_steps",    "kernel_dimension", "frequency_ratio",
        "period_s",     "verdict", "energy_ratio", "energy_ratio_min", "energy_ratio_max", "energy_joule",
        "objective",    "alpha",   "violations",   "solvers",          "agreement",        "tip_displacement",
        "contact_force"};
    for (const auto& name : promised) EXPECT_TRUE(orbit.contains(name)) << name;
    for (const char* name : {"cells", "free_steps", "contact_steps", "kernel_dimension"}) {
        EXPECT_TRUE(orbit[name].is_number_integer()) << name;
    }
    for (const char* name : {"gap", "frequency_ratio", "period_s"}) EXPECT_TRUE(orbit[name].is_number()) << name;
    for (const char* name : {"energy_ratio", "energy_ratio_min", "energy_ratio_max", "energy_joule"}) {
        EXPECT_TRUE(orbit[name].is_number() || orbit[name].is_null()) << name;
    }
    EXPECT_TRUE(orbit["verdict"].is_string());
    EXPECT_TRUE(orbit["agreement"].is_string());
    EXPECT_TRUE(orbit["objective"]["name"].is_string());
    EXPECT_TRUE(orbit["objective"].contains("value"));
    for (const char* name : {"periodicity", "cond1", "cond2", "cond3", "energy"}) {
        EXPECT_TRUE(orbit["violations"].contains(name)) << name;
    }
    for (const char* name : {"alpha", "solvers", "tip_displacement", "contact_force"}) {
        EXPECT_TRUE(orbit[name].is_array()) << name;
    }
    for (const auto& solver : orbit["solvers"]) {
        for (const char* name : {"name", "status", "objective", "violation", "iterations", "seconds"}) {
            EXPECT_TRUE(solver.contains(name)) << name;
        }
    }
}

TEST_F(Program, OrbitJsonOfAnAdmissibleLevel) {
    const Result result =
        run({"orbit", scene_, "--free", "16", "--contact", "4", "--energy", "12", "--solver", "both", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const json orbit = parsed(result.out);
    expect_fields(orbit);
    EXPECT_EQ(orbit["verdict"], "admissible");
    EXPECT_EQ(orbit["cells"], 6);
    EXPECT_EQ(orbit["kernel_dimension"], 4);
    EXPECT_NEAR(orbit["frequency_ratio"].get<double>(), 24.0 / 20.0, 1e-15);  // 4N/n_T
    EXPECT_NEAR(orbit["period_s"].get<double>(), 20.0 / 6.0, 1e-14);          // n_T L/(N c)
    EXPECT_NEAR(orbit["energy_ratio"].get<double>(), 12, 1e-11);              // the level to 1e-12
    EXPECT_NEAR(orbit["energy_ratio_min"].get<double>(), 9, 1e-11);
    EXPECT_NEAR(orbit["energy_ratio_max"].get<double>(), 36, 1e-10);
    EXPECT_NEAR(orbit["energy_joule"].get<double>(), 6, 1e-11);  // E_g = 1/2 J
    EXPECT_EQ(orbit["alpha"].size(), 4U);
    EXPECT_EQ(orbit["tip_displacement"].size(), 21U);
    EXPECT_EQ(orbit["contact_force"].size(), 20U);
    for (const auto& item : orbit["violations"].items()) EXPECT_LE(item.value().get<double>(), 1e-9) << item.key();
    EXPECT_EQ(orbit["objective"]["name"], "least-shock");
    EXPECT_EQ(orbit["agreement"], "agree");
    EXPECT_GE(orbit["solvers"].size(), 2U);
    for (int n = 0; n < 20; ++n) {
        const auto k = static_cast<std::size_t>(n);
        EXPECT_LE(orbit["tip_displacement"][k].get<double>(), 1 + 1e-9);
        EXPECT_LE(orbit["contact_force"][k].get<double>(), 1e-9);
        if (n < 16) {
            EXPECT_EQ(orbit["contact_force"][k].get<double>(), 0.0);
        }
    }
}

TEST_F(Program, OrbitWithoutAnOrbitHasNulls) {
    const Result above = run({"orbit", scene_, "--free", "16", "--contact", "4", "--energy", "1000", "--json"});
    EXPECT_EQ(above.exit_code, 3);
    json orbit = parsed(above.out);
    expect_fields(orbit);
    EXPECT_EQ(orbit["verdict"], "above");
    EXPECT_TRUE(orbit["energy_ratio"].is_null());
    EXPECT_TRUE(orbit["energy_joule"].is_null());
    EXPECT_TRUE(orbit["objective"]["value"].is_null());
    EXPECT_TRUE(orbit["violations"]["cond1"].is_null());
    EXPECT_EQ(orbit["alpha"].size(), 0U);

    const auto verdict = [&](const Words& more) {
        const Result result = run(with({"orbit", scene_, "--json"}, more));
        EXPECT_EQ(result.exit_code, 3);
        const json object = parsed(result.out);
        expect_fields(object);
        return object["verdict"].get<std::string>();
    };
    EXPECT_EQ(verdict({"--free", "16", "--contact", "4", "--energy", "1"}), "below");
    EXPECT_EQ(verdict({"--free", "16", "--contact", "4", "--gap", "-1"}), "inadmissible");
    EXPECT_EQ(verdict({"--free", "1", "--contact", "2", "--cells", "1"}), "trivial");
}

TEST_F(Program, OrbitWithoutALevelIsTheLeastEnergyOne) {
    const Result result = run({"orbit", scene_, "--free", "23", "--contact", "1", "--json"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NEAR(parsed(result.out)["energy_ratio"].get<double>(), 12.0 / 11.0, 1e-12);
}

TEST_F(Program, OrbitTextAndSolverChoices) {
    const Words words{"orbit", scene_, "--free", "16", "--contact", "4", "--energy", "12"};
    const Result text = run(words);
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_NE(text.out.find("admissible"), std::string::npos);
    for (const std::string solver : {"ipopt", "nlopt"}) {
        const Result result = run(with(words, {"--solver", solver, "--json"}));
        EXPECT_EQ(result.exit_code, 0);
        const json orbit = parsed(result.out);
        EXPECT_EQ(orbit["agreement"], "single");
        for (const auto& item : orbit["solvers"]) EXPECT_EQ(item["name"].get<std::string>().substr(0, 5), solver);
    }
    for (const std::string objective : {"nearest", "least-force"}) {
        const Result result = run(with(words, {"--objective", objective, "--json"}));
        EXPECT_EQ(result.exit_code, 0) << result.out;
        EXPECT_EQ(parsed(result.out)["objective"]["name"], objective);
    }
}

TEST_F(Program, ClosedGapSpeaksJoules) {
    const Result result = run(
        {"orbit", scene_, "--gap", "0", "--cells", "8", "--free", "16", "--contact", "8", "--energy", "2", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json orbit = parsed(result.out);
    expect_fields(orbit);
    EXPECT_NEAR(orbit["energy_joule"].get<double>(), 2, 2e-12);
    for (const char* name : {"energy_ratio", "energy_ratio_min", "energy_ratio_max"})
        EXPECT_TRUE(orbit[name].is_null());
    expect_refused({"orbit", scene_, "--gap", "0", "--cells", "8", "--free", "16", "--contact", "8"}, "--energy");
}

TEST_F(Program, NoNegativeZeros) {
    const Words words{"orbit", scene_, "--cells", "20", "--free", "48", "--contact", "16", "--energy", "60"};
    for (const Words& format : {Words{"--json"}, Words{}}) {
        const Result result = run(with(words, format));
        EXPECT_EQ(result.out.find(" -0 "), std::string::npos) << result.out;
        EXPECT_EQ(result.out.find("-0.0,"), std::string::npos) << result.out;
        EXPECT_EQ(result.out.find("-0.0\n"), std::string::npos) << result.out;
    }
}

}  // namespace
