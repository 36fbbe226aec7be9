// `nsma accuracy` and `sensitivity`.
#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;
using process::lines_of;

TEST_F(Program, AccuracyStudyRunsQuicklyAndRefusesWhatItCannotStudy) {
    const std::string out = path("accuracy");
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
    const std::string one = path("one");
    const Result done =
        run({"sensitivity", scene_, "--out", one, "--quiet", "--free", "16", "--contact", "4", "--energy", "12"});
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

    const std::string whole = path("whole");
    const Result all = run({"sensitivity", scene_, "--out", whole, "--quiet"});
    EXPECT_EQ(all.exit_code, 0) << all.err;
    for (const char* file :
         {"optima.csv", "prices.csv", "orbit-derivatives.csv", "intervals.csv", "relaxations.csv", "ablation.csv",
          "funnel.csv", "sensitivity.txt", "csv-metadata.json", "sensitivity.json", "charts/relaxation.png"}) {
        EXPECT_TRUE(fs::exists(fs::path(whole) / file)) << file;
    }
    const std::string before = contents(fs::path(whole) / "prices.csv");
    EXPECT_EQ(run({"sensitivity", scene_, "--out", whole, "--quiet"}).exit_code, 0);
    EXPECT_EQ(contents(fs::path(whole) / "prices.csv"), before);

    // Results of one scene only; a pattern that nothing meets has no optimum.
    const std::string other = write("other.toml", scene_text("1.0", "7"));
    EXPECT_EQ(run({"sensitivity", other, "--out", whole, "--quiet"}).exit_code, 2);
    EXPECT_EQ(run({"sensitivity", scene_, "--free", "5", "--contact", "5", "--out", path("none"), "--quiet"}).exit_code,
              3);
}

}  // namespace
