// Sweeps as processes: killed at any moment, gone on with, and shared by several ranks.

#include <cstdlib>
#include <random>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;
using process::Limits;
using process::wait_for;

class SweepProcess : public Program {
protected:
    std::string write_scene(const std::string& name, const std::string& objective, const std::string& levels) const {
        return write(name, scene_text("1.0", "3", "period = [1.0, 4.0]", levels, objective));
    }

    [[nodiscard]] pid_t start(const Words& words, const Limits& limits = {}) const {
        return process::start(words, folder_ / ".out", folder_ / ".out", limits);
    }
    [[nodiscard]] int run(const Words& words, const Limits& limits = {}) const {
        return process::finish(start(words, limits));
    }
    [[nodiscard]] std::string output() const { return contents(folder_ / ".out"); }
    void expect_one_line() const { EXPECT_EQ(output().find('\n'), output().size() - 1) << output(); }

    static Words sweep(const std::string& scene, const fs::path& out, bool resume = false,
                       const std::string& solver = "proof") {
        // Free patterns too, which take solvers some time.
        return with({NSMA_PROGRAM, "sweep", scene, "--out", out.string(), "--quiet", "--certify", "--all-kinds",
                     "--solver", solver},
                    resume ? Words{"--resume"} : Words{});
    }
    /// Sanitized ranks do not look for leaks: OpenMPI leaks in components that are unloaded before the report, so that
    /// no suppression can name them. The same sweep alone does look.
    static Words ranks(int count, const Words& words) {
        const char* given = std::getenv("ASAN_OPTIONS");
        return with({"env", "ASAN_OPTIONS=" + std::string(given == nullptr ? "" : given) + ":detect_leaks=0",
                     "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "mpirun", "--oversubscribe", "-n",
                     std::to_string(count)},
                    words);
    }

    static bool has_store(const fs::path& out) {
        return fs::exists(out / "results.sqlite.part-wal") || fs::exists(out / "results.sqlite");
    }

    static void expect_same(const fs::path& a, const fs::path& b) {
        for (const char* name : {"scene.toml", "patterns.csv", "levels.csv", "orbits.jsonl", "certificates.jsonl"}) {
            EXPECT_EQ(contents(a / name), contents(b / name)) << name;
            EXPECT_FALSE(contents(a / name).empty()) << name;
        }
        auto first = nlohmann::json::parse(contents(a / "summary.json"));
        auto second = nlohmann::json::parse(contents(b / "summary.json"));
        for (const char* time : {"seconds", "check_seconds"}) {
            first.erase(time);
            second.erase(time);
        }
        EXPECT_EQ(first, second);
    }

    /// Sweeps whose levels depend on others: Ipopt starts from the orbit before, eight levels in a row; `nearest`
    /// follows them all.
    struct Chained {
        std::string objective, solver, levels;
    };
    static std::vector<Chained> chained() {
        return {{"least-shock", "both", "[1.5, 1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 6.0, 9.0, 12.0]"},
                {"nearest", "proof", "[1.6, 3.0, 12.0]"}};
    }

    const std::string scene_ = write_scene("scene.toml", "least-shock", "[1.6, 3.0, 12.0]");
};

TEST_F(SweepProcess, KilledAtTwentyRandomMomentsItGoesOnToTheSameTables) {
    for (const auto& [objective, solver, levels] : chained()) {
        const std::string scene = write_scene(objective + ".toml", objective, levels);
        const auto begin = std::chrono::steady_clock::now();
        const fs::path whole = folder_ / (objective + "-whole");
        const int code = run(sweep(scene, whole, false, solver));
        ASSERT_TRUE(code == 0 || code == 4) << output();
        const auto length = std::chrono::steady_clock::now() - begin;
        // Where the kills fall changes nothing in what is expected.
        std::mt19937 random(20);
        std::uniform_real_distribution<double> share(0.0, 1.0);
        const fs::path out = folder_ / objective;
        for (int kills = 0; kills < 10; ++kills) {
            const pid_t child = start(sweep(scene, out, true, solver));
            std::this_thread::sleep_for(share(random) * length / 3);
            kill(child, SIGKILL);
            (void)process::finish(child);
        }
        EXPECT_EQ(run(sweep(scene, out, true, solver)), code) << output();
        expect_same(out, whole);
        EXPECT_TRUE(fs::exists(out / "results.sqlite"));
        EXPECT_FALSE(fs::exists(out / "results.sqlite.part"));
        // Once more changes nothing, nor does a new export.
        EXPECT_EQ(run(sweep(scene, out, true, solver)), code) << output();
        fs::remove(out / "levels.csv");
        EXPECT_EQ(run({NSMA_PROGRAM, "export", out.string()}), 0) << output();
        expect_same(out, whole);
    }
}

TEST_F(SweepProcess, AnyNumberOfRanksGivesTheSameTables) {
    for (const auto& [objective, solver, levels] : chained()) {
        const std::string scene = write_scene(objective + ".toml", objective, levels);
        const fs::path alone = folder_ / (objective + "-alone");
        const int code = run(sweep(scene, alone, false, solver));
        for (const int count : {1, 2, 4}) {
            const fs::path out = folder_ / (objective + std::to_string(count));
            const int shared = run(ranks(count, sweep(scene, out, false, solver)));
            if (shared == 127) GTEST_SKIP() << "no mpirun here";
            EXPECT_EQ(shared, code) << output();
            expect_same(out, alone);
        }
    }
}

/// Processes started by `parent`, the newest last.
std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    std::ifstream list("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
    for (pid_t child = 0; list >> child;) children.push_back(child);
    return children;
}

TEST_F(SweepProcess, ALostRankLosesNothingThatWasStored) {
    const fs::path alone = folder_ / "alone";
    const int code = run(sweep(scene_, alone));
    for (const bool all : {true, false}) {
        const fs::path out = folder_ / (all ? "all" : "one");
        const pid_t child = start(ranks(2, sweep(scene_, out)));
        // A minute at most for the store to be there; then every process at once, or the last rank alone, is killed.
        wait_for([&] { return has_store(out); }, 60);
        const auto started = children_of(child);
        if (all || started.empty()) {
            kill(-child, SIGKILL);
        } else {
            kill(started.back(), SIGKILL);
        }
        if (process::finish(child) == 127) GTEST_SKIP() << "no mpirun here";
        // The ranks see that mpirun is gone and end.
        int resumed = 2;
        for (int i = 0; i < 100 && resumed == 2; ++i) {
            resumed = run(sweep(scene_, out, true));
            if (resumed == 2) std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
        EXPECT_EQ(resumed, code) << output();
        expect_same(out, alone);
    }
}

TEST_F(SweepProcess, AWarningOfTheTimeLimitEndsRanksInOrder) {
    // Long enough that it cannot be done in the moment between the store's first breath and the signal.
    std::string levels = "[1.5";
    for (int i = 1; i < 40; ++i) levels += ", " + std::to_string(1.5 + 0.25 * i);
    const std::string scene = write_scene("long.toml", "least-shock", levels + "]");
    const fs::path alone = folder_ / "alone";
    const int code = run(sweep(scene, alone, false, "both"));
    const fs::path out = folder_ / "out";
    const pid_t child = start(ranks(2, sweep(scene, out, false, "both")));
    wait_for([&] { return has_store(out); }, 60);
    const bool was_done = fs::exists(out / "results.sqlite");
    kill(child, SIGUSR1);
    const int ended = process::finish(child);
    if (ended == 127) GTEST_SKIP() << "no mpirun here";
    EXPECT_EQ(ended, was_done ? code : 130) << output();
    EXPECT_TRUE(fs::exists(out / "levels.csv")) << output();
    EXPECT_EQ(run(sweep(scene, out, true, "both")), code) << output();
    expect_same(out, alone);
}

TEST_F(SweepProcess, AFullDiskLeavesAStoreToGoOnWith) {
    const fs::path whole = folder_ / "whole";
    const fs::path out = folder_ / "out";
    const int code = run(sweep(scene_, whole));
    // Room for the tables of the store and some rows of it.
    EXPECT_EQ(run(sweep(scene_, out), {.file_size = 150'000}), 2) << output();
    EXPECT_NE(output().find((out / "results.sqlite").string()), std::string::npos) << output();
    expect_one_line();
    EXPECT_EQ(run(sweep(scene_, out, true)), code) << output();
    expect_same(out, whole);
}

TEST_F(SweepProcess, AReadOnlyFolderIsRefusedAndKept) {
    const fs::path out = folder_ / "out";
    const int code = run(sweep(scene_, out));
    EXPECT_TRUE(code == 0 || code == 4) << output();
    const std::string store = contents(out / "results.sqlite");
    constexpr auto shut = fs::perms::group_write | fs::perms::others_write | fs::perms::owner_write;
    fs::permissions(folder_,
                    fs::perms::others_read | fs::perms::others_exec | fs::perms::group_read | fs::perms::group_exec,
                    fs::perm_options::add);
    for (const auto& place : {out / "charts", out}) fs::permissions(place, shut, fs::perm_options::remove);
    for (const auto& words : {sweep(scene_, out), sweep(scene_, out, true), sweep(scene_, out / "new"),
                              Words{NSMA_PROGRAM, "export", out.string()}, Words{NSMA_PROGRAM, "plot", out.string()}}) {
        const int refused = run(words, {.no_rights = true});
        if (refused == 126 || refused == 127) GTEST_SKIP() << "no other user, or none who reaches the program";
        EXPECT_EQ(refused, 2) << words[1] << ": " << output();
        EXPECT_NE(output().find(out.string()), std::string::npos) << output();
        expect_one_line();
    }
    EXPECT_EQ(contents(out / "results.sqlite"), store);
    for (const auto& place : {out / "charts", out})
        fs::permissions(place, fs::perms::owner_write, fs::perm_options::add);
    EXPECT_EQ(run(sweep(scene_, out, true)), code) << output();
}

TEST_F(SweepProcess, RefusalsAreOneLine) {
    const fs::path out = folder_ / "out";
    const int code = run(sweep(scene_, out));
    EXPECT_TRUE(code == 0 || code == 4) << output();
    const std::string other = write_scene("other.toml", "least-force", "[1.6]");
    EXPECT_EQ(run(sweep(other, out, true)), 2);
    EXPECT_NE(output().find("holds results of another scene"), std::string::npos) << output();
    EXPECT_EQ(run(sweep(scene_, out, true, "nlopt")), 2);
    EXPECT_NE(output().find("options: expected solver nlopt"), std::string::npos) << output();
    expect_one_line();
    EXPECT_EQ(run({NSMA_PROGRAM, "export", (folder_ / "nothing").string()}), 2);
    expect_one_line();
}

}  // namespace
