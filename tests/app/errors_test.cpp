// What the program says of itself, and of what it cannot take.
#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;

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
    const auto orbit = [&](const Words& more) { return with({"orbit", scene_}, more); };
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
    const auto one = [&](const Words& more) { return with({"orbit", scene_, "--free", "16", "--contact", "4"}, more); };
    for (const std::string energy : {"nan", "-1", "0", "inf", "much", ""}) {
        expect_refused(one({"--energy", energy}), "--energy");
    }
    expect_refused(one({"--objective", "beauty"}), "--objective");
    expect_refused(one({"--objective", "min-energy", "--energy", "12"}), "--energy");
    expect_refused(one({"--solver", "gurobi"}), "--solver");
    expect_refused(one({"--starts", "0"}), "--starts");
    expect_refused(one({"--gap", "nan"}), "--gap");
    expect_refused(one({"--gap", "1e-300"}));  // its square, the energy unit, vanishes
    expect_refused({"sweep", scene_}, "--out");
    const std::string out = path("sensitivity");
    const auto study = [&](const Words& more) { return with({"sensitivity", scene_, "--out", out}, more); };
    expect_refused({"sensitivity"}, "SCENE");
    expect_refused({"sensitivity", scene_}, "--out");
    expect_refused({"sensitivity", path("none.toml"), "--out", out}, "none.toml");
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
    expect_refused({"plot", path("nothing")}, "nothing");
    expect_refused({"scan", path("none.toml")}, "none.toml");
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
        expect_refused({"sweep", scene, "--out", path("results")}, item.named);
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

}  // namespace
