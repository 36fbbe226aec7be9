// End to end: the program as a user runs it, judged by its exit code, stdout, stderr and files.

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

extern char** environ;  // NOLINT: the name POSIX gives it

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

struct Result {
    int exit_code = -1;  ///< -signal when a signal ended it
    std::string out;
    std::string err;
};

class Program : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "nsma-app-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        scene_ = write("scene.toml", scene_text());
    }
    void TearDown() override { fs::remove_all(folder_); }

    static std::string scene_text(const std::string& gap = "1.0", const std::string& cells = "6",
                                  const std::string& patterns = "list = [[16, 4], [23, 1]]",
                                  const std::string& levels = "[1.6, 12.0]") {
        return "title = \"Test\"\n[bar]\nlength = 1.0\nyoung_modulus = 1.0\ndensity = 1.0\narea = 1.0\ngap = " + gap +
               "\n[mesh]\ncells = " + cells + "\n[patterns]\n" + patterns + "\n[levels]\nlist = " + levels +
               "\n[program]\nobjective = \"least-shock\"\n";
    }

    std::string write(const std::string& name, const std::string& text) {
        const fs::path path = folder_ / name;
        std::ofstream(path, std::ios::binary) << text;
        return path.string();
    }

    pid_t start(const std::vector<std::string>& words) {
        std::vector<std::string> all{NSMA_PROGRAM};
        all.insert(all.end(), words.begin(), words.end());
        std::vector<char*> pointers;
        for (auto& word : all) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        const std::string out = (folder_ / ".out").string();
        const std::string err = (folder_ / ".err").string();
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        pid_t child = -1;
        EXPECT_EQ(posix_spawn(&child, NSMA_PROGRAM, &actions, nullptr, pointers.data(), environ), 0);
        posix_spawn_file_actions_destroy(&actions);
        return child;
    }

    Result finish(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), contents(folder_ / ".out"),
                contents(folder_ / ".err")};
    }

    Result run(const std::vector<std::string>& words) { return finish(start(words)); }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
            const std::string name = fs::relative(entry.path(), folder_).string();
            if (name[0] != '.') names.push_back(name);
        }
        std::sort(names.begin(), names.end());
        return names;
    }

    /// Exit 2, one line on stderr, nothing on stdout, no file made.
    void expect_refused(const std::vector<std::string>& words, const std::string& named = {}) {
        std::string command;
        for (const auto& word : words) command += word + " ";
        SCOPED_TRACE(command);
        const auto before = files();
        const Result result = run(words);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_EQ(result.err.find("internal"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(named), std::string::npos) << result.err;
        EXPECT_EQ(files(), before);
    }

    fs::path folder_;
    std::string scene_;
};

json parsed(const Result& result) {
    EXPECT_EQ(result.out.find("nan"), std::string::npos);
    return json::parse(result.out);
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
    const json orbit = parsed(result);
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
    json orbit = parsed(above);
    expect_fields(orbit);
    EXPECT_EQ(orbit["verdict"], "above");
    EXPECT_TRUE(orbit["energy_ratio"].is_null());
    EXPECT_TRUE(orbit["energy_joule"].is_null());
    EXPECT_TRUE(orbit["objective"]["value"].is_null());
    EXPECT_TRUE(orbit["violations"]["cond1"].is_null());
    EXPECT_EQ(orbit["alpha"].size(), 0U);

    const auto verdict = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"orbit", scene_, "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const Result result = run(words);
        EXPECT_EQ(result.exit_code, 3);
        const json object = parsed(result);
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
    EXPECT_NEAR(parsed(result)["energy_ratio"].get<double>(), 12.0 / 11.0, 1e-12);
}

TEST_F(Program, OrbitTextAndSolverChoices) {
    const std::vector<std::string> words{"orbit", scene_, "--free", "16", "--contact", "4", "--energy", "12"};
    const Result text = run(words);
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_NE(text.out.find("admissible"), std::string::npos);
    for (const std::string solver : {"ipopt", "nlopt"}) {
        auto chosen = words;
        chosen.insert(chosen.end(), {"--solver", solver, "--json"});
        const Result result = run(chosen);
        EXPECT_EQ(result.exit_code, 0);
        const json orbit = parsed(result);
        EXPECT_EQ(orbit["agreement"], "single");
        for (const auto& item : orbit["solvers"]) EXPECT_EQ(item["name"].get<std::string>().substr(0, 5), solver);
    }
    for (const std::string objective : {"nearest", "least-force"}) {
        auto chosen = words;
        chosen.insert(chosen.end(), {"--objective", objective, "--json"});
        const Result result = run(chosen);
        EXPECT_EQ(result.exit_code, 0) << result.out;
        EXPECT_EQ(parsed(result)["objective"]["name"], objective);
    }
}

TEST_F(Program, ClosedGapSpeaksJoules) {
    const Result result = run(
        {"orbit", scene_, "--gap", "0", "--cells", "8", "--free", "16", "--contact", "8", "--energy", "2", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json orbit = parsed(result);
    expect_fields(orbit);
    EXPECT_NEAR(orbit["energy_joule"].get<double>(), 2, 2e-12);
    for (const char* name : {"energy_ratio", "energy_ratio_min", "energy_ratio_max"})
        EXPECT_TRUE(orbit[name].is_null());
    expect_refused({"orbit", scene_, "--gap", "0", "--cells", "8", "--free", "16", "--contact", "8"}, "--energy");
}

TEST_F(Program, ScanCsvAndPublicCounts) {
    const Result result = run({"scan", scene_, "--cells", "6", "--gap", "1", "--period", "0", "4", "--csv", "--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    const auto lines = lines_of(result.out);
    ASSERT_EQ(lines.size(), 1U + 209U);
    EXPECT_EQ(lines[0],
              "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,"
              "verdict,energy_ratio_min,energy_ratio_max,kind");
    int admissible = 0;
    int inadmissible = 0;
    int contact = 0;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        EXPECT_EQ(std::count(lines[i].begin(), lines[i].end(), ','), 10);
        if (lines[i].ends_with(",contact")) ++contact;
        if (lines[i].find(",admissible,") != std::string::npos) ++admissible;
        if (lines[i].find(",inadmissible,,") != std::string::npos) ++inadmissible;
    }
    EXPECT_EQ(admissible, 35);
    EXPECT_EQ(inadmissible, 209 - 35);
    EXPECT_EQ(contact, 18);
}

TEST_F(Program, ScanWithNothingAdmissibleIsThree) {
    EXPECT_EQ(run({"scan", scene_, "--gap", "-1"}).exit_code, 3);  // both patterns are of d > 0
    EXPECT_EQ(run({"scan", scene_}).exit_code, 0);
}

TEST_F(Program, HelpShowsExamplesAndVersionNamesTheLibraries) {
    for (const std::string command : {"", "scan", "orbit", "sweep", "plot"}) {
        const Result help = command.empty() ? run({"--help"}) : run({command, "--help"});
        EXPECT_EQ(help.exit_code, 0) << command;
        EXPECT_NE(help.out.find("xample"), std::string::npos) << command;
        EXPECT_NE(help.out.find("nsma " + command), std::string::npos) << command;
        EXPECT_EQ(help.err, "") << command;
    }
    const Result version = run({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    for (const char* library : {"Ipopt 3.", "NLopt 2.", "CLP 1."}) {
        EXPECT_NE(version.out.find(library), std::string::npos) << version.out;
    }
}

TEST_F(Program, BadFlagsAreOneLine) {
    const auto orbit = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"orbit", scene_};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    expect_refused({});
    expect_refused({"dance"});
    expect_refused({"scan"}, "SCENE");
    expect_refused({"scan", scene_, "--unknown"}, "--unknown");
    expect_refused({"scan", scene_, "--gap", "nan"}, "--gap");
    expect_refused({"scan", scene_, "--gap", "inf"}, "--gap");
    expect_refused({"scan", scene_, "--cells", "0"}, "--cells");
    expect_refused({"scan", scene_, "--cells", "-3"}, "--cells");
    expect_refused({"scan", scene_, "--cells", "2.5"}, "--cells");
    expect_refused({"scan", scene_, "--cells", "99999999999"}, "--cells");
    expect_refused({"scan", scene_, "--period", "4", "1", "--csv"}, "--period");
    expect_refused({"scan", scene_, "--period", "-1", "4", "--csv"}, "--period");
    expect_refused({"scan", scene_, "--period", "0", "nan", "--csv"}, "--period");
    expect_refused({"scan", scene_, "--period", "0", "1e300", "--csv"}, "period");
    expect_refused({"scan", scene_, "--period", "1"}, "--period");
    expect_refused(orbit({"--free", "16"}), "--contact");
    expect_refused(orbit({"--contact", "4"}), "--free");
    expect_refused(orbit({"--free", "0", "--contact", "4"}), "--free");
    expect_refused(orbit({"--free", "16", "--contact", "0"}), "--contact");
    expect_refused(orbit({"--free", "-16", "--contact", "4"}), "--free");
    expect_refused(orbit({"--free", "x", "--contact", "4"}), "--free");
    const std::vector<std::string> pattern{"--free", "16", "--contact", "4"};
    const auto with = [&](const std::vector<std::string>& more) {
        auto words = orbit(pattern);
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    for (const std::string energy : {"nan", "-1", "0", "inf", "much", ""}) {
        expect_refused(with({"--energy", energy}), "--energy");
    }
    expect_refused(with({"--objective", "beauty"}), "--objective");
    expect_refused(with({"--objective", "min-energy", "--energy", "12"}), "--energy");
    expect_refused(with({"--solver", "gurobi"}), "--solver");
    expect_refused(with({"--starts", "0"}), "--starts");
    expect_refused(with({"--gap", "nan"}), "--gap");
    expect_refused(with({"--gap", "1e-300"}));  // its square, the energy unit, vanishes
    expect_refused({"sweep", scene_}, "--out");
    const std::string out = (folder_ / "sensitivity").string();
    const auto study = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"sensitivity", scene_, "--out", out};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    expect_refused({"sensitivity"}, "SCENE");
    expect_refused({"sensitivity", scene_}, "--out");
    expect_refused({"sensitivity", (folder_ / "none.toml").string(), "--out", out}, "none.toml");
    expect_refused({"sensitivity", scene_, "--out", scene_}, "expected a folder");
    expect_refused(study({"--free", "16"}), "--contact");
    expect_refused(study({"--free", "0", "--contact", "4"}), "--free");
    expect_refused(study({"--free", "16", "--contact", "4", "--energy", "-1"}), "--energy");
    expect_refused(study({"--free", "16", "--contact", "4", "--energy", "nan"}), "--energy");
    expect_refused(study({"--energy", "12"}), "--free");
    expect_refused(study({"--objective", "beauty"}), "--objective");
    expect_refused(study({"--free", "16", "--contact", "4", "--energy", "12", "--objective", "min-energy"}),
                   "--energy");
    expect_refused(study({"--solver", "gurobi"}), "--solver");
    const std::string closed = write("closed.toml", scene_text("0.0"));
    expect_refused({"sensitivity", closed, "--free", "16", "--contact", "4", "--out", out}, "--energy");
    EXPECT_FALSE(fs::exists(out));
    expect_refused({"plot"}, "DIR");
    expect_refused({"plot", (folder_ / "nothing").string()}, "nothing");
    expect_refused({"scan", (folder_ / "none.toml").string()}, "none.toml");
    expect_refused({"scan", folder_.string()});  // a folder is no scene
}

TEST_F(Program, BadScenesAreOneLine) {
    const auto changed = [](const std::string& from, const std::string& to) {
        std::string text = scene_text();
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    struct Case {
        std::string text;
        std::string named;
    };
    const std::vector<Case> cases{
        {"", "expected a scene"},
        {"this is no TOML", ""},
        {changed("length = 1.0\n", ""), "length"},
        {changed("length = 1.0", "length = -1.0"), "length"},
        {changed("length = 1.0", "length = 0.0"), "length"},
        {changed("length = 1.0", "length = nan"), "length"},
        {changed("length = 1.0", "length = inf"), "length"},
        {changed("length = 1.0", "length = \"long\""), "length"},
        {changed("length = 1.0", "length = 1.0\nlenght = 2.0"), "lenght"},
        {changed("length = 1.0", "length = 1.0\nlength = 2.0"), "length"},
        {changed("gap = 1.0", "gap = nan"), "gap"},
        {changed("gap = 1.0", "gap = [1.0]"), "gap"},
        {changed("cells = 6", "cells = 0"), "cells"},
        {changed("cells = 6", "cells = -6"), "cells"},
        {changed("cells = 6", "cells = 6.5"), "cells"},
        {changed("cells = 6", "cells = 10000000000"), "cells"},
        {changed("[[16, 4], [23, 1]]", "[[16, 0]]"), "list"},
        {changed("[[16, 4], [23, 1]]", "[[0, 4]]"), "list"},
        {changed("[[16, 4], [23, 1]]", "[[16, 4, 2]]"), "list"},
        {changed("[[16, 4], [23, 1]]", "[[16, 4.5]]"), "list"},
        {changed("list = [[16, 4], [23, 1]]", "mode = 0"), "mode"},
        {changed("list = [[16, 4], [23, 1]]", "mode = 1\nperiod = [0.0, 4.0]"), "patterns"},
        {changed("list = [[16, 4], [23, 1]]", "period = [4.0, 1.0]"), "period"},
        {changed("[1.6, 12.0]", "[-1.0]"), "list"},
        {changed("[1.6, 12.0]", "[nan]"), "list"},
        {changed("[1.6, 12.0]", "[0.0]"), "list"},
        {changed("least-shock", "beauty"), "objective"},
        {changed("[program]", "[programme]"), "program"},
    };
    for (const auto& item : cases) {
        SCOPED_TRACE(item.text);
        const std::string scene = write("bad.toml", item.text);
        expect_refused({"scan", scene, "--csv"}, item.named);
        expect_refused({"sweep", scene, "--out", (folder_ / "results").string()}, item.named);
    }
    expect_refused({"orbit", write("bad.toml", ""), "--free", "16", "--contact", "4", "--json"});
}

TEST_F(Program, UnwritableOutputIsOneLine) {
    const std::string file = write("occupied", "a file");
    expect_refused({"sweep", scene_, "--out", file}, "occupied");
    expect_refused({"sweep", scene_, "--out", file + "/below"}, "occupied");
    expect_refused({"sweep", scene_, "--out", "/proc/nsma"}, "/proc/nsma");
    EXPECT_EQ(contents(file), "a file");
}

TEST_F(Program, SweepAgainIsTheSameToTheByte) {
    const std::string scene = write("tiny.toml", scene_text("1.0", "4", "period = [3.0, 4.0]", "[1.6, 6.0]"));
    const fs::path out = folder_ / "out" / "deeper";
    const Result first = run({"sweep", scene, "--out", out.string(), "--quiet"});
    EXPECT_EQ(first.exit_code, 0) << first.err << first.out;
    EXPECT_EQ(first.err, "");
    const std::vector<std::string> stable{"scene.toml", "patterns.csv", "levels.csv", "orbits.jsonl"};
    for (const char* name :
         {"scene.toml", "patterns.csv", "levels.csv", "orbits.jsonl", "timings.csv", "summary.txt", "summary.json"}) {
        EXPECT_TRUE(fs::is_regular_file(out / name)) << name;
        EXPECT_FALSE(fs::exists((out / name).string() + ".part")) << name;
    }
    EXPECT_EQ(contents(out / "scene.toml"), contents(scene));
    std::vector<std::string> before;
    for (const auto& name : stable) before.push_back(contents(out / name));
    // Every line of orbits.jsonl is an admissible orbit.
    const auto orbits = lines_of(before[3]);
    EXPECT_GT(orbits.size(), 3U);
    for (const auto& line : orbits) EXPECT_EQ(json::parse(line)["verdict"], "admissible");
    const json summary = json::parse(contents(out / "summary.json"));
    EXPECT_EQ(summary["patterns"], 11 + 12 + 13 + 14 + 15);  // n_T = 12..16
    EXPECT_EQ(summary["interrupted"], false);
    EXPECT_EQ(summary["levels"].get<int>(), 2 * summary["kinds"]["contact"].get<int>());

    EXPECT_EQ(run({"sweep", scene, "--out", out.string(), "--quiet"}).exit_code, 0);
    for (std::size_t i = 0; i < stable.size(); ++i) EXPECT_EQ(contents(out / stable[i]), before[i]) << stable[i];

    // Another scene may not touch it.
    const Result refused = run({"sweep", scene_, "--out", out.string(), "--quiet"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(lines_of(refused.err).size(), 1U);
    for (std::size_t i = 0; i < stable.size(); ++i) EXPECT_EQ(contents(out / stable[i]), before[i]) << stable[i];

    // Charts can be drawn again.
    ASSERT_TRUE(fs::exists(out / "charts"));
    fs::remove_all(out / "charts");
    const Result plot = run({"plot", out.string()});
    EXPECT_EQ(plot.exit_code, 0) << plot.err;
    EXPECT_NE(plot.out.find("chart"), std::string::npos);
    EXPECT_EQ(run({"plot", out.string(), "--quiet"}).out, "");
    int pictures = 0;
    for (const auto& entry : fs::directory_iterator(out / "charts")) {
        if (entry.path().extension() == ".svg" || entry.path().extension() == ".png") {
            ++pictures;
            EXPECT_GT(entry.file_size(), 1000U);
        }
    }
    EXPECT_GE(pictures, 2);
}

TEST_F(Program, FreeAndStuckPatternsAreLeftUnlessAskedFor) {
    const std::string scene = write("six.toml", scene_text("1.0", "6", "period = [0.0, 4.0]", "[1.6, 12.0]"));
    const auto sweep = [&](const char* folder, std::vector<std::string> more) {
        std::vector<std::string> words{"sweep", scene, "--out", (folder_ / folder).string(), "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    };
    const auto rows_of = [&](const char* folder) {
        std::vector<std::string> rows;
        for (const auto& line : lines_of(contents(folder_ / folder / "levels.csv"))) {
            if (line[0] != '#' && line.find(",admissible,") != std::string::npos) rows.push_back(line);
        }
        return rows;
    };
    EXPECT_EQ(sweep("contact", {}).exit_code, 0);
    EXPECT_EQ(sweep("all", {"--all-kinds"}).exit_code % 4, 0);
    EXPECT_EQ(sweep("distinct", {"--distinct"}).exit_code, 0);
    const json summary = json::parse(contents(folder_ / "contact" / "summary.json"));
    EXPECT_EQ(summary["kinds"], (json{{"contact", 18}, {"free", 17}, {"stuck", 0}}));
    EXPECT_EQ(summary["left"], 17);
    EXPECT_EQ(summary["levels"], 2 * 18);
    EXPECT_EQ(summary["global"], summary["solved"]);
    const json all = json::parse(contents(folder_ / "all" / "summary.json"));
    EXPECT_EQ(all["left"], 0);
    EXPECT_EQ(all["levels"], 2 * 35);
    // The verdicts are the same, kinds and all; the contact motions too.
    EXPECT_EQ(contents(folder_ / "all" / "patterns.csv"), contents(folder_ / "contact" / "patterns.csv"));
    std::vector<std::string> contact_rows;
    for (const auto& row : rows_of("all")) {
        if (row.find(",contact,") != std::string::npos) contact_rows.push_back(row);
        EXPECT_TRUE(row.find(",contact,false,") != std::string::npos || row.find(",free,true,") != std::string::npos)
            << row;
    }
    EXPECT_EQ(contact_rows, rows_of("contact"));
    // One row a motion: the copies, and nothing but them, are left out.
    EXPECT_GT(summary["copies"].get<int>(), 0);
    EXPECT_LT(rows_of("distinct").size(), rows_of("contact").size());
    for (const auto& row : rows_of("distinct"))
        EXPECT_NE(contents(folder_ / "contact" / "levels.csv").find(row), std::string::npos);
    EXPECT_EQ(run({"export", (folder_ / "contact").string(), "--distinct"}).exit_code, 0);
    EXPECT_EQ(contents(folder_ / "contact" / "levels.csv"), contents(folder_ / "distinct" / "levels.csv"));
    // The orbit of least energy has its row, and its level another, though they are one motion.
    const std::string twice = write("twice.toml", scene_text("1.0", "20", "list = [[60, 10]]", "[4.0]"));
    EXPECT_EQ(run({"sweep", twice, "--out", (folder_ / "twice").string(), "--distinct", "--quiet"}).exit_code, 0);
    EXPECT_EQ(rows_of("twice").size(), 2U);

    // The scene may ask as well; another choice is another sweep.
    const std::string asking =
        write("asking.toml", scene_text("1.0", "6", "period = [0.0, 4.0]\nkinds = \"all\"", "[1.6, 12.0]"));
    EXPECT_EQ(run({"sweep", asking, "--out", (folder_ / "asked").string(), "--quiet"}).exit_code % 4, 0);
    EXPECT_EQ(rows_of("asked"), rows_of("all"));
    expect_refused({"sweep", scene, "--out", (folder_ / "all").string(), "--quiet", "--resume"}, "kinds");
    const std::string wrong =
        write("wrong.toml", scene_text("1.0", "6", "period = [0.0, 4.0]\nkinds = \"some\"", "[1.6]"));
    expect_refused({"scan", wrong}, "kinds");
    // Only a free pattern: a verdict, no orbit, and a word on how to get it.
    const std::string grazing = write("grazing.toml", scene_text("1.0", "6", "list = [[23, 1]]", "[1.6]"));
    const Result left = run({"sweep", grazing, "--out", (folder_ / "left").string(), "--quiet"});
    EXPECT_EQ(left.exit_code, 3);
    EXPECT_NE(left.err.find("nsma: no pattern of the scene is a contact motion; --all-kinds solves the other 1\n"),
              std::string::npos)
        << left.err;
    const Result one = run({"orbit", scene_, "--free", "23", "--contact", "1"});
    EXPECT_EQ(one.out.find("kind          free: "), 0U) << one.out;
}

TEST_F(Program, SweepWhereNothingIsAdmissibleIsThree) {
    const std::string scene = write("above.toml", scene_text("1.0", "6", "list = [[16, 4]]", "[1e6]"));
    const Result result = run({"sweep", scene, "--out", (folder_ / "out").string(), "--quiet"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_EQ(json::parse(contents(folder_ / "out" / "summary.json"))["above"], 1);
}

TEST_F(Program, InterruptedSweepKeepsReadableRows) {
    std::string levels = "[1.1";
    for (int i = 2; i < 400; ++i) levels += ", " + std::to_string(1 + 0.1 * i);
    const std::string scene = write("long.toml", scene_text("1.0", "12", "period = [0.0, 4.0]", levels + "]"));
    const fs::path out = folder_ / "out";
    const pid_t child = start({"sweep", scene, "--out", out.string(), "--quiet", "--all-kinds", "--solver", "both"});
    // Wait for a few rows, a minute at most.
    for (int i = 0; i < 1200; ++i) {
        std::error_code code;  // the store's journal grows with every result
        const auto size = fs::file_size(out / "results.sqlite.part-wal", code);
        if (!code && size > 300'000) break;
        siginfo_t ended{};
        ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT), 0);
        if (ended.si_pid != 0) break;  // finish() tells how it ended
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    kill(child, SIGINT);
    const Result result = finish(child);
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.out.find("interrupted"), std::string::npos) << result.out;
    EXPECT_EQ(json::parse(contents(out / "summary.json"))["interrupted"], true);
    std::size_t rows = 0;
    long columns = -1;
    for (const auto& line : lines_of(contents(out / "levels.csv"))) {
        if (line[0] == '#') continue;
        if (line.find('"') != std::string::npos) continue;  // a quoted comma
        const long commas = std::count(line.begin(), line.end(), ',');
        if (columns < 0) columns = commas;
        EXPECT_EQ(commas, columns) << line;
        ++rows;
    }
    // How far it came depends on the machine; what a kill loses is tested with the store.
    EXPECT_GE(rows, 1U);
    for (const auto& line : lines_of(contents(out / "orbits.jsonl"))) EXPECT_TRUE(json::accept(line));
    EXPECT_EQ(contents(out / "levels.csv").back(), '\n');
}

TEST_F(Program, CertificatesAreWrittenAndVerified) {
    const std::string proofs = (folder_ / "proofs.jsonl").string();
    const Result proved = run({"prove", scene_, "--cells", "6", "--period", "0", "4", "--out", proofs, "--quiet"});
    EXPECT_EQ(proved.exit_code, 0) << proved.err;
    EXPECT_NE(
        proved.out.find(
            "276 patterns, 276 proved; 35 admissible (18 contact, 17 free, 0 stuck), greatest energy exact for 35\n"),
        std::string::npos)
        << proved.out;
    EXPECT_FALSE(fs::exists(proofs + ".part"));
    EXPECT_EQ(lines_of(contents(proofs)).size(), 276U);
    const Result checked = run({"check", proofs});
    EXPECT_EQ(checked.exit_code, 0) << checked.out;
    EXPECT_EQ(checked.out, "276 certificates valid, 0 rejected\n");
    // An existing file is kept.
    const std::string before = contents(proofs);
    expect_refused({"prove", scene_, "--out", proofs, "--quiet"}, "proofs.jsonl");
    EXPECT_EQ(contents(proofs), before);

    // One false statement: the line, the pattern and what fails.
    std::string forged = before;
    const auto at = forged.find("\"kind\":\"contact\"");
    ASSERT_NE(at, std::string::npos);
    forged.replace(at, 16, "\"kind\":\"free\"");
    const std::string file = write("forged.jsonl", forged);
    const Result rejected = run({"check", file});
    EXPECT_EQ(rejected.exit_code, 4);
    const long line = 1 + std::count(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    EXPECT_EQ(rejected.out.rfind(file + ":" + std::to_string(line) + ": (6, ", 0), 0U) << rejected.out;
    EXPECT_NE(rejected.out.find("rejected: kind: a contact step carries a wave, so free is not proved\n275 "
                                "certificates valid, 1 rejected\n"),
              std::string::npos)
        << rejected.out;
    // No certificates, none of this version, no object.
    expect_refused({"check", write("none.jsonl", "")}, "expected certificates");
    expect_refused({"check", write("text.jsonl", "hello\n")}, "text.jsonl:1");
    std::string old = lines_of(before)[0];
    old.replace(old.find(":2,"), 3, ":1,");
    expect_refused({"check", write("old.jsonl", old + "\n")}, "expected 2, got 1");
}

TEST_F(Program, InterruptedProofsAreNotTakenForWhole) {
    const std::string proofs = (folder_ / "proofs.jsonl").string();
    const pid_t child = start({"prove", scene_, "--cells", "200", "--period", "0", "4", "--out", proofs, "--quiet"});
    for (int i = 0; i < 1200; ++i) {
        std::error_code code;
        if (fs::file_size(proofs + ".part", code) > 100'000 && !code) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    kill(child, SIGINT);
    const Result result = finish(child);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_FALSE(fs::exists(proofs));
    EXPECT_NE(result.out.find("interrupted: those so far are in " + proofs + ".part"), std::string::npos) << result.out;
    EXPECT_EQ(run({"check", proofs + ".part"}).exit_code, 0);  // whole lines
}

TEST_F(Program, ScanMethodsAgreeToTheByte) {
    const std::vector<std::string> words{"scan", scene_, "--cells", "8", "--period", "0", "4", "--csv", "--quiet"};
    auto integers = words;
    integers.insert(integers.end(), {"--method", "integers"});
    const Result certified = run(words);
    EXPECT_EQ(certified.exit_code, 0);
    EXPECT_EQ(run(integers).out, certified.out);
    const auto lines = lines_of(certified.out);
    EXPECT_EQ(
        std::count_if(lines.begin(), lines.end(), [](const std::string& line) { return line.ends_with(",contact"); }),
        23);
    EXPECT_EQ(
        std::count_if(lines.begin(), lines.end(), [](const std::string& line) { return line.ends_with(",free"); }), 15);
    expect_refused({"scan", scene_, "--method", "magic"}, "--method");
}

TEST_F(Program, NoNegativeZeros) {
    for (const std::string format : {"--json", ""}) {
        std::vector<std::string> words{"orbit", scene_,      "--cells", "20",       "--free",
                                       "48",    "--contact", "16",      "--energy", "60"};
        if (!format.empty()) words.push_back(format);
        const Result result = run(words);
        EXPECT_EQ(result.out.find(" -0 "), std::string::npos) << result.out;
        EXPECT_EQ(result.out.find("-0.0,"), std::string::npos) << result.out;
        EXPECT_EQ(result.out.find("-0.0\n"), std::string::npos) << result.out;
    }
}

TEST_F(Program, AccuracyStudyRunsQuicklyAndRefusesWhatItCannotStudy) {
    const std::string out = (folder_ / "accuracy").string();
    const std::string closed = write("closed.toml", scene_text("0.0"));
    for (const auto& words :
         std::vector<std::vector<std::string>>{{"accuracy", closed, "--out", out},
                                               {"accuracy", scene_},
                                               {"accuracy", scene_, "--out", scene_},
                                               {"accuracy", scene_, "--out", out, "--quick=maybe"}}) {
        const Result result = run(words);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
    }
    const Result done = run({"accuracy", scene_, "--out", out, "--quick", "--quiet"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(done.err.empty()) << done.err;
    for (const char* file : {"programs.csv", "stability.csv", "causes.csv", "winners.csv", "machine.txt",
                             "charts/accuracy-programs.png"}) {
        EXPECT_TRUE(fs::exists(fs::path(out) / file)) << file;
    }
    // Results of one scene only.
    const std::string other = write("other.toml", scene_text("1.0", "7"));
    EXPECT_EQ(run({"accuracy", other, "--out", out, "--quick", "--quiet"}).exit_code, 2);
}

TEST_F(Program, SensitivityStudyOfOnePatternAndOfTheScene) {
    const std::string one = (folder_ / "one").string();
    const std::vector<std::string> pattern{"--free", "16", "--contact", "4", "--energy", "12"};
    std::vector<std::string> words{"sensitivity", scene_, "--out", one, "--quiet"};
    words.insert(words.end(), pattern.begin(), pattern.end());
    const Result done = run(words);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(done.err.empty()) << done.err;
    EXPECT_NE(done.out.find("optima 1:"), std::string::npos) << done.out;
    EXPECT_TRUE(fs::exists(fs::path(one) / "charts/binding.png"));
    // The energy's price and the gap's: Euler's identity from the printed numbers.
    double gap = 0, energy = 0;
    for (const auto& line : lines_of(contents(fs::path(one) / "prices.csv"))) {
        std::vector<std::string> fields;
        std::istringstream stream(line);
        for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
        if (fields.size() > 16 && fields[7] == "gap") gap = std::stod(fields[16]);
        if (fields.size() > 16 && fields[7] == "energy") energy = std::stod(fields[16]);
    }
    EXPECT_NEAR(gap + 2 * energy, 2.0, 1e-8);

    const std::string whole = (folder_ / "whole").string();
    const Result all = run({"sensitivity", scene_, "--out", whole, "--quiet"});
    EXPECT_EQ(all.exit_code, 0) << all.err;
    for (const char* file :
         {"optima.csv", "prices.csv", "orbit-derivatives.csv", "intervals.csv", "relaxations.csv", "ablation.csv",
          "funnel.csv", "sensitivity.txt", "charts/funnel.png", "charts/counts.svg"}) {
        EXPECT_TRUE(fs::exists(fs::path(whole) / file)) << file;
    }
    const std::string before = contents(fs::path(whole) / "prices.csv");
    EXPECT_EQ(run({"sensitivity", scene_, "--out", whole, "--quiet"}).exit_code, 0);
    EXPECT_EQ(contents(fs::path(whole) / "prices.csv"), before);

    // Results of one scene only; a pattern that nothing meets has no optimum.
    const std::string other = write("other.toml", scene_text("1.0", "7"));
    EXPECT_EQ(run({"sensitivity", other, "--out", whole, "--quiet"}).exit_code, 2);
    EXPECT_EQ(
        run({"sensitivity", scene_, "--free", "5", "--contact", "5", "--out", (folder_ / "none").string(), "--quiet"})
            .exit_code,
        3);
}

}  // namespace
