// `nsma forced` and `nsma march`.
#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;
using process::lines_of;

class Forced : public Program {
protected:
    [[nodiscard]] std::string driven(const std::string& more = "") const {
        return write("driven.toml", scene_text() +
                                        "[damping]\nkind = \"tip\"\nvalue = 0.05\n[forcing]\namplitude = 0.1\nfrom = "
                                        "0.95\nto = 1.1\ncount = 4\nsettle = 20\nrecord = 10\n" +
                                        more);
    }
};

TEST_F(Forced, TheResponseIsWrittenDrawnAndExportedAgain) {
    const std::string scene = driven();
    const Result result = run({"forced", scene, "--out", path("out"), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("mode 1 alone predicts that it ends at "), std::string::npos) << result.out;
    const fs::path out = folder_ / "out";
    for (const char* name : {"response.csv", "balance.csv", "forced.txt", "forced.jsonl", "charts/response.svg"})
        EXPECT_TRUE(fs::exists(out / name)) << name;
    const std::string table = contents(out / "response.csv");
    EXPECT_EQ(lines_of(table).size(), 1U + 8U);
    // The same again, exported and drawn; and solved once more.
    fs::remove(out / "response.csv");
    fs::remove_all(out / "charts");
    EXPECT_EQ(run({"export", out.string()}).exit_code, 0);
    EXPECT_EQ(contents(out / "response.csv"), table);
    EXPECT_EQ(run({"plot", out.string(), "--format", "svg"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(out / "charts" / "response.svg"));
    const std::string records = contents(out / "forced.jsonl");
    EXPECT_EQ(run({"forced", scene, "--out", path("out"), "--quiet"}).exit_code, 0);
    EXPECT_EQ(contents(out / "forced.jsonl"), records);
}

TEST_F(Forced, AnInterruptedRunAsksAndGoesOn) {
    const std::string scene = driven();
    ASSERT_EQ(run({"forced", scene, "--out", path("out"), "--quiet"}).exit_code, 0);
    const fs::path records = folder_ / "out" / "forced.jsonl";
    const std::string whole = contents(records);
    // What a kill leaves: some points, the last one torn.
    fs::remove(records);
    write("out/forced.jsonl.part", whole.substr(0, whole.size() / 2));
    expect_refused({"forced", scene, "--out", path("out"), "--quiet"}, "expected --resume to go on with it or --fresh");
    EXPECT_EQ(run({"forced", scene, "--out", path("out"), "--quiet", "--resume"}).exit_code, 0);
    EXPECT_EQ(contents(records), whole);
    fs::remove(records);
    write("out/forced.jsonl.part", "nonsense\nmore\n");
    expect_refused({"forced", scene, "--out", path("out"), "--quiet", "--resume"}, "is damaged: line 1");
    EXPECT_EQ(run({"forced", scene, "--out", path("out"), "--quiet", "--fresh"}).exit_code, 0);
    EXPECT_EQ(contents(records), whole);
}

TEST_F(Forced, ASignalKeepsThePointsSoFar) {
    std::string text = contents(driven());
    text.replace(text.find("count = 4"), 9, "count = 4000");
    text.replace(text.find("settle = 20"), 11, "settle = 5000");
    const std::string scene = write("long.toml", text);
    const pid_t child = start({"forced", scene, "--out", path("out"), "--quiet"});
    process::wait_for(
        [&] {
            std::error_code code;
            const auto size = fs::file_size(folder_ / "out" / "forced.jsonl.part", code);
            return (!code && size > 2000) || process::ended(child);
        },
        60);
    kill(child, SIGINT);
    const Result result = finish(child);
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.out.find("--resume goes on with them"), std::string::npos) << result.out;
    EXPECT_FALSE(fs::exists(folder_ / "out" / "forced.jsonl"));
}

TEST_F(Forced, WithoutForcingItSaysSo) {
    expect_refused({"forced", scene_, "--out", path("out")}, "forcing: expected a table [forcing], got nothing");
    EXPECT_FALSE(fs::exists(path("out")));
    expect_refused({"forced", driven("strength = 1\n"), "--out", path("out")}, "an unknown key");
}

TEST_F(Forced, AnOrbitThatIsLetGoKeepsItsPattern) {
    const Result result = run({"march", scene_, "--free", "16", "--contact", "4", "--periods", "1000"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("the first is (16, 4), kept for all"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("marched       1000 periods of 20 steps, no damping"), std::string::npos) << result.out;
    const Result moved = run({"march", scene_, "--free", "16", "--contact", "4", "--perturb", "0.1"});
    EXPECT_EQ(moved.exit_code, 0);
    EXPECT_NE(moved.out.find("moved by 0.1 of its norm"), std::string::npos) << moved.out;
    // The same from its state: six cells of a scene of six.
    std::string state = "stress_pa,velocity_m_s\n";
    for (int i = 0; i < 6; ++i) state += "0,0.5\n";
    const Result given = run({"march", scene_, "--state", write("state.csv", state)});
    EXPECT_TRUE(given.exit_code == 0 || given.exit_code == 3) << given.err;
    EXPECT_NE(given.out.find("marched       100 periods of 24 steps"), std::string::npos) << given.out;
    std::string inside = "stress_pa,velocity_m_s\n";
    for (int i = 0; i < 6; ++i) inside += "2,0\n";
    expect_refused({"march", scene_, "--state", write("inside.csv", inside)},
                   "expected a tip that is not inside the wall, got one 1 m beyond it");
    expect_refused({"march", scene_}, "expected either --state or --free and --contact, got neither");
    expect_refused({"march", scene_, "--state", path("none.csv")}, "none.csv");
    expect_refused({"march", scene_, "--free", "16", "--contact", "4", "--energy", "1e5"},
                   "expected a pattern with an orbit there, got above");
    expect_refused({"march", scene_, "--free", "16", "--contact", "4", "--perturb", "2"}, "--perturb");
}

}  // namespace
