// Streams, signals and launchers: what surrounds the program.
#include <csignal>

#include <sys/stat.h>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;

class Surroundings : public Program {
protected:
    /// A shell that runs the program, "$0", with the words as "$@".
    [[nodiscard]] Result shell(const std::string& line, const Words& words) const {
        return finish(
            process::start(with({"sh", "-c", line, NSMA_PROGRAM}, words), folder_ / ".out", folder_ / ".err"));
    }
    [[nodiscard]] Words prove(const std::string& out) const {
        return {"prove", scene_, "--cells", "6", "--period", "0", "4", "--out", path(out), "--quiet"};
    }
    /// Starts it, gives it a moment, and asks it to end.
    [[nodiscard]] Result ended_by(int signal, const Words& words) const {
        const pid_t child = start(words);
        // Handlers are set within the first milliseconds; all of these go on for minutes, or for ever.
        process::wait_for([&] { return process::ended(child); }, 1.0);
        EXPECT_FALSE(process::ended(child)) << "too short to be interrupted";
        kill(child, signal);
        EXPECT_TRUE(process::wait_for([&] { return process::ended(child); }, 30)) << words.front();
        kill(child, SIGKILL);
        return finish(child);
    }
    /// Levels of a chain of 400 columns, each of which solvers take long for.
    [[nodiscard]] Words long_orbit() const {
        return {"orbit",     scene_, "--cells",  "100", "--free",   "399",
                "--contact", "1",    "--energy", "50",  "--solver", "both"};
    }
};

TEST_F(Surroundings, AClosedStreamIsNotTheNextFile) {
    ASSERT_EQ(run(prove("whole")).exit_code, 0);
    // Without --quiet, and with a pattern that is told of on stderr, messages would be lines of the result.
    for (const std::string closed : {"0<&-", "2>&-", "0<&- 2>&-"}) {
        fs::remove(path("out"));
        EXPECT_EQ(shell("exec \"$0\" \"$@\" " + closed, prove("out")).exit_code, 0) << closed;
        EXPECT_EQ(contents(path("out")), contents(path("whole"))) << closed;
    }
    fs::remove(path("out"));
    EXPECT_EQ(shell("exec \"$0\" \"$@\" >&- 2>&-", prove("out")).exit_code, 2);
    EXPECT_EQ(contents(path("out")), contents(path("whole")));
}

TEST_F(Surroundings, OutputThatCannotBeWrittenIsTwo) {
    ASSERT_EQ(run(prove("proofs")).exit_code, 0);
    ASSERT_EQ(run({"sweep", scene_, "--out", path("sweep"), "--quiet"}).exit_code, 0);
    const std::vector<Words> commands{{"--help"},
                                      {"--version"},
                                      {"scan", scene_},
                                      {"scan", scene_, "--cells", "40", "--period", "0", "4", "--csv"},
                                      {"orbit", scene_, "--free", "16", "--contact", "4"},
                                      {"check", path("proofs")},
                                      {"export", path("sweep")},
                                      {"plot", path("sweep")}};
    for (const Words& words : commands) {
        SCOPED_TRACE(words.front());
        for (const std::string where : {">/dev/full", ">&-"}) {
            const Result result = shell("exec \"$0\" \"$@\" " + where, words);
            EXPECT_EQ(result.exit_code, 2) << where;
            EXPECT_EQ(result.err.find("nsma: standard output: cannot be written: "), 0U) << result.err;
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        }
        // stderr is for those who read it.
        EXPECT_EQ(shell("exec \"$0\" \"$@\" 2>/dev/full", words).exit_code, run(words).exit_code);
    }
}

TEST_F(Surroundings, AReaderThatHasEnoughIsNoError) {
    const Result result = shell("{ \"$0\" \"$@\"; echo $? >&2; } | head -1",
                                {"scan", scene_, "--cells", "60", "--period", "0", "4", "--csv"});
    EXPECT_EQ(result.err, "141\n");  // as of a program that SIGPIPE ended
    EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
}

TEST_F(Surroundings, TheFirstSignalEndsWhateverGoesOn) {
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const Words long_scan{"scan", write("long.toml", scene_text("1.0", "1000000", "mode = 1"))};
    for (const Words& words : {Words{"scan", path("pipe")}, Words{"check", path("pipe")}, long_orbit(), long_scan,
                               with(long_scan, {"--method", "integers"})}) {
        SCOPED_TRACE(words.front());
        EXPECT_EQ(ended_by(SIGTERM, words).exit_code, 143);
        const Result interrupted = ended_by(SIGINT, words);
        EXPECT_EQ(interrupted.exit_code, 130);
        EXPECT_EQ(interrupted.err, "");
    }
}

TEST_F(Surroundings, AProofThatIsInterruptedLeavesAPartFile) {
    // A spectrum of 320,000 patterns.
    const Words words{"prove", scene_, "--cells", "400", "--period", "0", "4", "--out", path("out")};
    const Result result = ended_by(SIGTERM, words);
    EXPECT_EQ(result.exit_code, 143);
    EXPECT_NE(result.out.find("interrupted: those so far are in " + path("out") + ".part"), std::string::npos);
    EXPECT_FALSE(fs::exists(path("out")));
    EXPECT_TRUE(fs::exists(path("out.part")));
}

TEST_F(Surroundings, AFolderIsForOneProcess) {
    std::string levels = "[1.1";
    for (int i = 2; i < 400; ++i) levels += ", " + std::to_string(1 + 0.1 * i);
    const std::string scene = write("long.toml", scene_text("1.0", "12", "period = [0.0, 4.0]", levels + "]"));
    const std::string out = path("out");
    const pid_t first =
        process::start({NSMA_PROGRAM, "sweep", scene, "--out", out, "--quiet", "--all-kinds", "--solver", "both"},
                       path(".1"), path(".2"));
    process::wait_for([&] { return fs::exists(out + "/results.sqlite.part-wal") || process::ended(first); }, 60);
    for (const Words& words : {Words{"sweep", scene, "--out", out}, Words{"sweep", scene, "--out", out, "--resume"},
                               Words{"export", out}, Words{"plot", out}, Words{"sensitivity", scene, "--out", out}}) {
        const Result refused = run(words);
        EXPECT_EQ(refused.exit_code, 2) << words.front();
        EXPECT_EQ(refused.err, "nsma: " + out + ": is in use by process " + std::to_string(first) + "\n");
    }
    kill(first, SIGKILL);
    EXPECT_EQ(process::finish(first), -SIGKILL);
    EXPECT_EQ(run({"export", out}).exit_code, 0);  // the lock went with its process
}

TEST_F(Surroundings, VariablesOfAnotherLaunchMakeNoRanks) {
    const std::string alone = path("alone");
    const int code = run({"sweep", scene_, "--out", alone, "--quiet"}).exit_code;
    for (const std::string rank : {"0", "1"}) {
        const std::string out = path("leaked" + rank);
        const Words words{"env", "OMPI_COMM_WORLD_SIZE=2", "OMPI_COMM_WORLD_RANK=" + rank,
                          // OpenMPI's own leaks
                          "ASAN_OPTIONS=detect_leaks=0", NSMA_PROGRAM, "sweep", scene_, "--out", out, "--quiet"};
        const pid_t child = process::start(words, path(".out"), path(".err"));
        EXPECT_TRUE(process::wait_for([&] { return process::ended(child); }, 60)) << "hangs";
        kill(child, SIGKILL);
        EXPECT_EQ(finish(child).exit_code, code);
        EXPECT_EQ(contents(out + "/levels.csv"), contents(alone + "/levels.csv"));
        // What it refuses it says, whatever rank it is told to be.
        const Result refused = shell(
            "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=" + rank + " ASAN_OPTIONS=detect_leaks=0 exec \"$0\" \"$@\"",
            {"sweep", path("none.toml"), "--out", out});
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_NE(refused.err.find("none.toml: expected a scene file"), std::string::npos) << refused.err;
    }
}

TEST_F(Surroundings, WhatCannotBeReadSaysWhy) {
    fs::create_directory(path("shut"));
    fs::permissions(folder_, fs::perms::all, fs::perm_options::add);
    fs::permissions(path("shut"), fs::perms::none);
    for (const Words& words :
         {Words{"export", path("shut")}, Words{"plot", path("shut")}, Words{"report", path("shut")}}) {
        const pid_t child =
            process::start(with({NSMA_PROGRAM}, words), path(".out"), path(".err"), {.no_rights = true});
        const Result refused = finish(child);
        if (refused.exit_code >= 126) break;  // no other user here, or none who reaches the program
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_NE(refused.err.find("Permission denied"), std::string::npos) << refused.err;
    }
    fs::permissions(path("shut"), fs::perms::owner_all);
    expect_refused({"export", path("shut")}, "got one without results.sqlite");
}

TEST_F(Surroundings, NumbersAreDecimalAndInRange) {
    const auto count = [&](const std::string& cells) {
        const Result result = run({"scan", scene_, "--cells", cells, "--period", "0", "4", "--csv"});
        EXPECT_EQ(result.exit_code, 0) << cells;
        return std::count(result.out.begin(), result.out.end(), '\n');
    };
    EXPECT_EQ(count("010"), count("10"));
    EXPECT_EQ(count("+10"), count("10"));
    EXPECT_NE(count("8"), count("10"));
    for (const std::string cells : {"0x10", "1e1", "10 ", " 10", "10,", "--10", "+-10"})
        expect_refused({"scan", scene_, "--cells=" + cells}, "--cells");
    for (const std::string gap : {"1e-400", "1e400", "1e-200", "1e60", "0x1", "1,5"})
        expect_refused({"scan", scene_, "--gap=" + gap}, "gap: expected");
    for (const std::string energy : {"1e-200", "1e200", "1e-400"})
        expect_refused({"orbit", scene_, "--free", "16", "--contact", "4", "--energy", energy}, "--energy: expected");
    // Beyond every period there is no contact, and no number that wraps around.
    const std::string beyond =
        write("beyond.toml", scene_text("1.0", "6", "period = [2.0, 4.0]\ncontact = [1e300, 1e301]"));
    const Result none = run({"scan", beyond, "--csv"});
    EXPECT_EQ(none.exit_code, 3);
    EXPECT_EQ(std::count(none.out.begin(), none.out.end(), '\n'), 1) << none.out;
    // More patterns, or levels over them, than memory holds.
    expect_refused({"scan", scene_, "--cells", "10000", "--period", "0", "4"},
                   "patterns: expected at most 10000000, got");
    const std::string many = "from = 1.0\nto = 9.0\ncount = 1000000\nspacing = \"log\"";
    std::string text = scene_text("1.0", "1000", "period = [0.0, 4.0]");
    text.replace(text.find("list = [1.6, 12.0]"), 18, many);
    expect_refused({"sweep", write("many.toml", text), "--out", path("out")}, "levels: expected at most");
    // One pattern of too many unknowns is a row with its reason.
    const Result large = run({"orbit", scene_, "--cells", "100000", "--free", "399999", "--contact", "1"});
    EXPECT_EQ(large.exit_code, 4);
    EXPECT_NE(large.out.find("expected at most 10000 unknowns, got 199999"), std::string::npos) << large.out;
}

TEST_F(Surroundings, WordsThatDoNotGoTogetherAreRefused) {
    expect_refused({"swep"}, "got swep");
    expect_refused({"--foo"}, "got --foo");
    expect_refused({}, "got none");
    expect_refused({"prove", scene_, "--free", "16", "--contact", "4", "--period", "0", "4", "--out", path("out")},
                   "--period");
    expect_refused({"scan", scene_, "--cells", std::string(5000, '7')}, "--cells");
    const Result long_word = run({std::string(5000, 'k')});
    EXPECT_LT(long_word.err.size(), 300U);
}

TEST_F(Surroundings, AForgedCertificateKeepsNobodyBusy) {
    // Each is refused or rejected with its reason before the work it asks for is done.
    const std::string head = R"({"certificate":3,"cells":)";
    std::string digits(9000, '7'), rows;
    for (int n = 1; n < 24; ++n)
        rows +=
            (n > 1 ? ",[" : "[") + std::to_string(n) + ",\"1/" + digits.replace(0, 2, std::to_string(10 + n)) + "\"]";
    const struct {
        std::string text, reason;
    } forged[]{
        {head + R"(20,"free_steps":48,"contact_steps":16,"gap_sign":1,"claim":"empty","projection":[)" + rows + "]}",
         "expected a fraction"},
        {head + R"(1000000,"free_steps":6400000,"contact_steps":3200000,"gap_sign":0,"claim":"empty","chain":[0]})",
         "chain: column"},
        {head + R"(1000,"free_steps":2400,"contact_steps":800,"gap_sign":1,"claim":"nonempty","kind":"contact",)" +
             R"("energy_least":"25","optimum":{"objective":"least-shock","energy":"26","bound":"1","value":"9","energy_error":"1",)" +
             R"("orbit":[[0,"-1"]],"window":400,"multiplier":"1/)" + digits.substr(0, 200) + "\"}}",
         "expected multipliers of at most 80 bits"},
        {head + R"(10000,"free_steps":24000,"contact_steps":8000,"gap_sign":1,"claim":"nonempty","kind":"contact",)" +
             R"("energy_least":"25","optimum":{"objective":"least-shock","energy":"26","bound":"1","value":"9","energy_error":"1",)" +
             R"("orbit":[[0,"-1"]],"window":4000,"multiplier":"-1/1208925819614629174706175"}})",
         "rejected: "},
        {head + std::string(80'000, '[') + std::string(80'000, ']') + "}", "expected brackets at most 16 deep"},
        {head + std::string(80'000, '['), "expected brackets at most 16 deep"},
        {head + R"(6,"free_steps":16,"contact_steps":4,"gap_sign":1,"claim":"empty",)" + "\"" + std::string(5000, 'k') +
             "\":1}",
         "kkk..."}};
    for (const auto& [text, reason] : forged) {
        const pid_t child = start({"check", write("forged.jsonl", text + "\n")});
        EXPECT_TRUE(process::wait_for([&] { return process::ended(child); }, 30)) << reason;
        kill(child, SIGKILL);
        const Result result = finish(child);
        EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 4) << result.exit_code;
        EXPECT_NE((result.out + result.err).find(reason), std::string::npos) << result.out << result.err;
        EXPECT_LT(result.err.size(), 300U);
    }
}

TEST_F(Surroundings, AnOrbitIsDrawnWhereItIsAskedFor) {
    const auto has = [&](const std::string& name) { return fs::exists(path(name)) && fs::file_size(path(name)) > 100; };
    const Result one = run({"orbit", scene_, "--free", "16", "--contact", "4", "--energy", "6J", "--out", path("one")});
    EXPECT_EQ(one.exit_code, 0) << one.err;
    EXPECT_NE(one.out.find("energy        6 J = 12 E_g"), std::string::npos) << one.out;  // E_g = 1/2 J
    for (const char* name :
         {"one/orbit.json", "one/orbit-curves.csv", "one/charts/orbit-motion.svg", "one/charts/orbit-fields.png"})
        EXPECT_TRUE(has(name)) << name;
    EXPECT_EQ(process::lines_of(contents(path("one/orbit-curves.csv"))).size(), 1U + 21U);  // n = 0..n_T
    ASSERT_EQ(run({"sweep", scene_, "--out", path("sweep"), "--quiet", "--cells", "6", "--gap", "1"}).exit_code, 0);
    EXPECT_EQ(run({"plot", path("sweep"), "--orbit", "16,4,11.95"}).exit_code, 0);
    EXPECT_TRUE(has("sweep/charts/orbit-16-4-12-motion.png"));  // as one who rounds would have it
    expect_refused({"plot", path("sweep"), "--orbit", "16,4,11"}, "got those at the least, 9 E_g, 12 E_g");
    EXPECT_EQ(run({"plot", path("sweep"), "--orbit", "16,4"}).exit_code, 0);
    EXPECT_TRUE(has("sweep/charts/orbit-16-4-fields.svg"));
    EXPECT_EQ(run({"plot", path("sweep"), "--orbit", "17,4"}).exit_code, 2);
    for (const std::string word : {"16", "16,", "16,4,", "16,4,x", "-1,4", "16,4,12,3"})
        expect_refused({"plot", path("sweep"), "--orbit", word}, "--orbit: expected R,P");
    EXPECT_EQ(run({"export", path("sweep"), "--curves"}).exit_code, 0);
    EXPECT_TRUE(has("sweep/curves.csv"));
}

TEST_F(Surroundings, EveryFolderIsExportedAndPlotted) {
    const auto has = [&](const std::string& name) { return fs::exists(path(name)) && fs::file_size(path(name)) > 100; };
    const std::vector<std::string> one{"--free", "16", "--contact", "4", "--energy", "12"};
    ASSERT_EQ(run(with({"orbit", scene_, "--out", path("orbit")}, one)).exit_code, 0);
    // A sweep and a sensitivity study of one scene share a folder.
    ASSERT_EQ(run({"sweep", scene_, "--out", path("both"), "--quiet"}).exit_code, 0);
    ASSERT_EQ(run(with({"sensitivity", scene_, "--out", path("both"), "--quiet"}, one)).exit_code, 0);
    ASSERT_EQ(run({"accuracy", scene_, "--out", path("accuracy"), "--quick", "--quiet"}).exit_code, 0);
    const std::vector<std::pair<std::string, Words>> folders{
        {"orbit", {"orbit-curves.csv", "charts/orbit-motion"}},
        {"both", {"levels.csv", "prices.csv", "charts/overview", "charts/binding"}},
        {"accuracy", {"programs.csv", "winners.csv", "charts/accuracy-programs"}}};
    for (const auto& [folder, files] : folders) {
        std::map<std::string, std::string> before;
        for (const std::string& file : files) {
            if (!file.ends_with(".csv")) continue;
            before[file] = contents(path(folder + "/" + file));
            fs::remove(path(folder + "/" + file));
        }
        fs::remove_all(path(folder + "/charts"));
        const Result exported = run({"export", path(folder)});
        EXPECT_EQ(exported.exit_code, 0) << exported.err;
        for (const auto& [file, text] : before) EXPECT_EQ(contents(path(folder + "/" + file)), text) << file;
        const Result plotted = run({"plot", path(folder), "--format", "pdf,svg", "--size", "400x300"});
        EXPECT_EQ(plotted.exit_code, 0) << plotted.err;
        for (const std::string& file : files) {
            if (file.ends_with(".csv")) continue;
            EXPECT_TRUE(has(folder + "/" + file + ".pdf")) << file;
            EXPECT_TRUE(has(folder + "/" + file + ".svg")) << file;
            EXPECT_FALSE(has(folder + "/" + file + ".png")) << file;
        }
    }
    // A sweep leaves a page, a study when it is asked for; that of a shared folder has both.
    EXPECT_TRUE(has("both/report.html"));
    EXPECT_FALSE(has("accuracy/report.html"));
    const Result page = run({"report", path("accuracy"), "--out", path("page.html")});
    EXPECT_EQ(page.exit_code, 0) << page.err;
    EXPECT_EQ(page.out, "report   " + path("page.html") + "\n");
    EXPECT_TRUE(has("page.html"));
    const auto before = contents(path("both/report.html"));
    EXPECT_EQ(run({"report", path("both")}).exit_code, 0);
    EXPECT_GT(contents(path("both/report.html")).size(), before.size());  // the prices of the study
    EXPECT_LT(before.size(), 1'000'000U);
    expect_refused({"report", path("orbit")}, "expected the folder of a sweep or of an accuracy study");
    expect_refused({"report", path("nowhere")}, "got nothing");
    expect_refused({"report", path("both"), "--out", path("nowhere/page.html")}, "cannot be written");
    expect_refused({"plot", path("orbit"), "--orbit", "16,4"}, "--orbit: expected the folder of a sweep");
    expect_refused({"export", path("accuracy"), "--distinct"}, "--distinct: expected the folder of a sweep");
    for (const std::string word : {"gif", "svg,gif", "", "svg,,pdf"})
        expect_refused({"plot", path("both"), "--format", word}, "--format: expected svg, png, pdf");
    for (const std::string word : {"10", "x", "400x", "x300", "400x300x2", "1e3", "-400", "99999"})
        expect_refused({"plot", path("both"), "--size", word}, "--size: expected WIDTH");
    // A damaged study beside a sweep is told, and takes nothing from it.
    write("both/sensitivity.json", "damaged");
    const Result beside = run({"sweep", scene_, "--out", path("both"), "--quiet"});
    EXPECT_EQ(beside.exit_code, 0);
    EXPECT_NE(beside.err.find("no report: "), std::string::npos) << beside.err;
}

TEST_F(Surroundings, WithoutGnuplotTheTablesAreComplete) {
    fs::create_directory(path("empty"));
    const Result result =
        shell("PATH=" + path("empty") + " exec \"$0\" \"$@\"", {"sweep", scene_, "--out", path("out"), "--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find("install gnuplot-nox"), std::string::npos) << result.err;
    EXPECT_TRUE(fs::exists(path("out/levels.csv")));
}

TEST_F(Surroundings, AnInterruptedSweepIsNotBegunAnewByMistake) {
    ASSERT_EQ(run({"sweep", scene_, "--out", path("out"), "--quiet"}).exit_code, 0);
    fs::rename(path("out/results.sqlite"), path("out/results.sqlite.part"));
    const Result refused = run({"sweep", scene_, "--out", path("out"), "--quiet"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("expected --resume to go on with it or --fresh to begin anew"), std::string::npos);
    expect_refused({"sweep", scene_, "--out", path("out"), "--fresh", "--resume"}, "excludes");
    EXPECT_EQ(run({"sweep", scene_, "--out", path("out"), "--quiet", "--fresh"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(path("out/results.sqlite")));
}

TEST_F(Surroundings, AListedPatternKeepsItsRow) {
    const std::string scene =
        write("listed.toml", scene_text("1.0", "6", "list = [[16, 4], [15, 4]]"));  // g = 1, q odd
    const Result result = run({"scan", scene, "--csv"});
    EXPECT_NE(result.out.find("6,1,15,4,19,0,"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(",trivial,"), std::string::npos) << result.out;
}

TEST_F(Surroundings, WhatIsMissingIsNamedAtOnce) {
    expect_refused({"orbit", scene_}, "expected --free, --contact as well (see nsma orbit --help)");
    expect_refused({"swep"}, "did you mean sweep?");
}

}  // namespace
