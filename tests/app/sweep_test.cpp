// `nsma sweep`, `export` and `plot`: the folder of a sweep.
#include "program.hpp"

#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using process::contents;
using process::lines_of;

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
    const auto sweep = [&](const char* folder, const Words& more) {
        return run(with({"sweep", scene, "--out", path(folder), "--quiet"}, more));
    };
    const auto rows_of = [&](const char* folder) {
        std::vector<std::string> rows;
        for (const auto& line : lines_of(contents(folder_ / folder / "levels.csv"))) {
            if (line.find(",admissible,") != std::string::npos) rows.push_back(line);
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
    EXPECT_EQ(run({"export", path("contact"), "--distinct"}).exit_code, 0);
    EXPECT_EQ(contents(folder_ / "contact" / "levels.csv"), contents(folder_ / "distinct" / "levels.csv"));
    // The orbit of least energy has its row, and its level another, though they are one motion.
    const std::string twice = write("twice.toml", scene_text("1.0", "20", "list = [[60, 10]]", "[4.0]"));
    EXPECT_EQ(run({"sweep", twice, "--out", path("twice"), "--distinct", "--quiet"}).exit_code, 0);
    EXPECT_EQ(rows_of("twice").size(), 2U);

    // The scene may ask as well; another choice is another sweep.
    const std::string asking =
        write("asking.toml", scene_text("1.0", "6", "period = [0.0, 4.0]\nkinds = \"all\"", "[1.6, 12.0]"));
    EXPECT_EQ(run({"sweep", asking, "--out", path("asked"), "--quiet"}).exit_code % 4, 0);
    EXPECT_EQ(rows_of("asked"), rows_of("all"));
    expect_refused({"sweep", scene, "--out", path("all"), "--quiet", "--resume"}, "kinds");
    const std::string wrong =
        write("wrong.toml", scene_text("1.0", "6", "period = [0.0, 4.0]\nkinds = \"some\"", "[1.6]"));
    expect_refused({"scan", wrong}, "kinds");
    // Only a free pattern: a verdict, no orbit, and a word on how to get it.
    const std::string grazing = write("grazing.toml", scene_text("1.0", "6", "list = [[23, 1]]", "[1.6]"));
    const Result left = run({"sweep", grazing, "--out", path("left"), "--quiet"});
    EXPECT_EQ(left.exit_code, 3);
    EXPECT_NE(left.err.find("nsma: no pattern of the scene is a contact motion; --all-kinds solves the other 1\n"),
              std::string::npos)
        << left.err;
    const Result one = run({"orbit", scene_, "--free", "23", "--contact", "1"});
    EXPECT_NE(one.out.find("\nkind          free: "), std::string::npos) << one.out;
}

// With --certify every orbit has a certificate, which is checked from its line alone.
TEST_F(Program, SweepCertifiesEveryOrbit) {
    for (const std::string objective : {"least-shock", "least-force", "nearest"}) {
        SCOPED_TRACE(objective);
        const std::string scene =
            write(objective + ".toml", scene_text("1.0", "6", "period = [0.0, 4.0]", "[1.6, 3.0, 12.0]", objective));
        const fs::path out = folder_ / objective;
        EXPECT_EQ(run({"sweep", scene, "--out", out.string(), "--quiet", "--certify"}).exit_code, 0);
        const json summary = json::parse(contents(out / "summary.json"));
        EXPECT_GT(summary["solved"], 5);
        EXPECT_EQ(summary["proved_exactly"], summary["solved"]);
        EXPECT_EQ(summary["certificate_bytes"], fs::file_size(out / "certificates.jsonl"));
        std::size_t orbits = 0;
        for (const auto& line : lines_of(contents(out / "orbits.jsonl"))) {
            EXPECT_EQ(json::parse(line)["proof"], "proved exactly");
            ++orbits;
        }
        EXPECT_EQ(summary["certificates"], orbits);
        const Result checked = run({"check", path(objective + "/certificates.jsonl")});
        EXPECT_EQ(checked.exit_code, 0);
        EXPECT_EQ(checked.out.find(std::to_string(orbits) + " certificates valid, 0 rejected\n" +
                                   std::to_string(summary["solved"].get<int>()) + " best orbits among them"),
                  0U)
            << checked.out;
        // The table is made again from the store, and is gone with a sweep that asks for none.
        const std::string lines = contents(out / "certificates.jsonl");
        EXPECT_EQ(run({"export", out.string()}).exit_code, 0);
        EXPECT_EQ(contents(out / "certificates.jsonl"), lines);
        expect_refused({"sweep", scene, "--out", out.string(), "--quiet", "--resume"}, "certified");
        EXPECT_EQ(run({"sweep", scene, "--out", out.string(), "--quiet"}).exit_code, 0);
        EXPECT_FALSE(fs::exists(out / "certificates.jsonl"));
        EXPECT_NE(contents(out / "levels.csv").find(",proved in floating point\n"), std::string::npos);
        EXPECT_EQ(contents(out / "levels.csv").find("exactly"), std::string::npos);
    }
}

// What is not proved is said in words: of free patterns with less than the whole search.
TEST_F(Program, SweepSaysHowGoodEachOrbitIs) {
    const std::string scene = write("eight.toml", scene_text("1.0", "8", "period = [2.0, 4.0]", "[1.6, 3.0]"));
    (void)run({"sweep", scene, "--out", path("out"), "--quiet", "--certify", "--all-kinds", "--solver", "nlopt"});
    int exact = 0, gaps = 0;
    for (const auto& line : lines_of(contents(folder_ / "out" / "levels.csv"))) {
        exact += line.ends_with(",proved exactly") ? 1 : 0;
        gaps += line.ends_with(" %") || line.ends_with(",no bound") ? 1 : 0;
    }
    EXPECT_GT(exact, 0);
    EXPECT_GT(gaps, 0) << contents(folder_ / "out" / "levels.csv");
}

TEST_F(Program, SweepWhereNothingIsAdmissibleIsThree) {
    const std::string scene = write("above.toml", scene_text("1.0", "6", "list = [[16, 4]]", "[1e6]"));
    const Result result = run({"sweep", scene, "--out", path("out"), "--quiet"});
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
    process::wait_for(
        [&] {
            std::error_code code;  // the store's journal grows with every result
            const auto size = fs::file_size(out / "results.sqlite.part-wal", code);
            return (!code && size > 300'000) || process::ended(child);  // finish() tells how it ended
        },
        60);
    kill(child, SIGINT);
    const Result result = finish(child);
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.out.find("interrupted"), std::string::npos) << result.out;
    EXPECT_EQ(json::parse(contents(out / "summary.json"))["interrupted"], true);
    std::size_t rows = 0;
    long columns = -1;
    for (const auto& line : lines_of(contents(out / "levels.csv"))) {
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

}  // namespace
