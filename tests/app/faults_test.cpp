// What the system may refuse at any moment: each write, flush, renaming and allocation of small runs fails once, and
// each system call of the store is once the last. Whatever happens then, going on gives the same tables to the byte.

#include <cstdlib>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;

// Every so many of the faults; the sanitizers make a run ten times longer.
#ifdef __SANITIZE_ADDRESS__
constexpr int stride = 7;
#else
constexpr int stride = 1;
#endif
constexpr int killed = -9;

struct Call {
    const char* name;
    const char* error;
};

class Faults : public Program {
protected:
    Faults() {
        // Charts are drawn by another process, which has its own troubles; this one only takes its time.
        fs::create_directory(folder_ / ".tools");
        const fs::path gnuplot = folder_ / ".tools" / "gnuplot";
        std::ofstream(gnuplot) << "#!/bin/sh\nname=${2%.gp}\nprintf 'a whole picture</svg>' > \"$name.svg\"\n"
                                  "printf 'a whole picture IEND' > \"$name.png\"\n";
        fs::permissions(gnuplot, fs::perms::owner_all);
    }

    struct Ended {
        int code;
        std::string err;
        std::string trace;  ///< what strace saw
    };

    /// A program with those tools, in front of `words` perhaps one that disturbs it.
    [[nodiscard]] Ended run(const Words& words, const Words& disturb = {}) const {
        const char* options = std::getenv("ASAN_OPTIONS");
        const Words environment{"env", "PATH=" + (folder_ / ".tools").string() + ":" + std::getenv("PATH"),
                                // the search for leaks needs what strace has: the right to trace
                                "ASAN_OPTIONS=" + std::string(options == nullptr ? "" : options) + ":detect_leaks=0"};
        const Words program = with({NSMA_PROGRAM}, words);
        const int code = process::finish(
            process::start(with(environment, with(disturb, program)), folder_ / ".out", folder_ / ".err"));
        return {code, contents(folder_ / ".err"), contents(folder_ / ".trace")};
    }

    [[nodiscard]] Words strace(const std::string& call, const std::string& fault, int number) const {
        return {"strace",
                "-o",
                (folder_ / ".trace").string(),
                "-e",
                "trace=" + call,
                "-e",
                "inject=" + call + ":" + fault + ":when=" + std::to_string(number)};
    }
    [[nodiscard]] bool can_trace() const { return run({"--version"}, strace("write", "error=EIO", 1000)).code == 0; }

    [[nodiscard]] Words sweep(const std::string& out, const Words& more = {}) const {
        return with({"sweep", scene_, "--out", path(out), "--quiet"}, more);
    }

    void expect_tables_of(const std::string& out) const {
        for (const char* name : {"scene.toml", "patterns.csv", "levels.csv", "orbits.jsonl"}) {
            EXPECT_EQ(contents(folder_ / out / name), contents(folder_ / "whole" / name)) << name;
        }
    }

    /// The run ended as it should have, or with one line that says why not.
    static void expect_orderly(const Ended& ended, int code) {
        if (ended.code == code) return;
        EXPECT_TRUE(ended.code == 2 || ended.code == 4) << ended.code << ": " << ended.err;
        EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
        EXPECT_EQ(ended.err.find("internal error"), std::string::npos) << ended.err;
    }

    /// `judge` sees every run in which the fault came about; how many there were.
    template <class Judge>
    int each_fault(const Call& call, const Words& words, const std::string& fresh, const Judge& judge) const {
        int faults = 0;
        for (int number = 1;; number += stride) {
            fs::remove_all(folder_ / fresh);
            fs::remove(folder_ / (fresh + ".part"));
            const Ended ended = run(words, strace(call.name, std::string("error=") + call.error, number));
            if (ended.trace.find("(INJECTED)") == std::string::npos) return faults;
            if (ended.code == 127) continue;  // the loader of the program, not the program
            SCOPED_TRACE(std::string(call.name) + " " + std::to_string(number));
            judge(ended);
            ++faults;
            if (HasFailure()) return faults;
        }
    }
};

constexpr Call outputs[]{{"write", "ENOSPC"},  {"pwrite64", "ENOSPC"}, {"fsync", "EIO"},    {"fdatasync", "EIO"},
                         {"rename", "ENOSPC"}, {"ftruncate", "EIO"},   {"mkdir", "ENOSPC"}, {"unlink", "EIO"}};

TEST_F(Faults, ASweepSurvivesEveryFailedCall) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    const Ended whole = run(sweep("whole"));
    ASSERT_TRUE(whole.code == 0 || whole.code == 3) << whole.err;
    for (const Call& call : outputs) {
        const int faults = each_fault(call, sweep("out"), "out", [&](const Ended& ended) {
            expect_orderly(ended, whole.code);
            const Ended resumed = run(sweep("out", {"--resume"}));
            EXPECT_EQ(resumed.code, whole.code) << resumed.err;
            expect_tables_of("out");
            EXPECT_FALSE(fs::exists(folder_ / "out" / "results.sqlite.part"));
        });
        EXPECT_GE(faults, 1) << call.name;  // else nothing was tested
        RecordProperty(call.name, faults);
        if (HasFailure()) return;
    }
}

TEST_F(Faults, ASweepSurvivesEveryReadThatFails) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    const Ended whole = run(sweep("whole"));
    fs::copy(folder_ / "whole", folder_ / "out", fs::copy_options::recursive);
    for (const Call& call : {Call{"pread64", "EIO"}, {"read", "EIO"}}) {
        const int faults = each_fault(call, {"export", path("out")}, "nothing", [&](const Ended& ended) {
            expect_orderly(ended, 0);
            expect_tables_of("out");  // those before, or the same again
        });
        EXPECT_GE(faults, 1) << call.name;
        RecordProperty(call.name, faults);
    }
    EXPECT_EQ(run({"export", path("out")}).code, 0);
    EXPECT_EQ(run(sweep("out", {"--resume"})).code, whole.code);
    expect_tables_of("out");
}

TEST_F(Faults, ASweepKilledAtEveryCallGoesOn) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    const Ended whole = run(sweep("whole"));
    int kills = 0;
    for (const char* call : {"write", "pwrite64", "fsync", "fdatasync", "rename", "ftruncate", "unlink"}) {
        for (int number = 1;; number += stride) {
            SCOPED_TRACE(std::string(call) + " " + std::to_string(number));
            fs::remove_all(folder_ / "out");
            const Ended ended = run(sweep("out"), strace(call, "signal=KILL", number));
            if (ended.code != killed) break;
            ++kills;
            const Ended resumed = run(sweep("out", {"--resume"}));
            EXPECT_EQ(resumed.code, whole.code) << resumed.err;
            expect_tables_of("out");
            if (HasFailure()) return;
        }
    }
    RecordProperty("kills", kills);
    EXPECT_GE(kills, 60 / stride);  // the store alone writes more often
}

TEST_F(Faults, ProofsAreWholeOrNotThere) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    const auto prove = [&](const std::string& out) -> Words {
        return {"prove", scene_, "--out", path(out), "--quiet"};
    };
    ASSERT_EQ(run(prove("whole")).code, 0);
    for (const Call& call :
         {Call{"write", "ENOSPC"}, {"ftruncate", "EIO"}, {"fsync", "EIO"}, {"rename", "ENOSPC"}, {"close", "EIO"}}) {
        const int faults = each_fault(call, prove("out"), "out", [&](const Ended& ended) {
            expect_orderly(ended, 0);
            if (fs::exists(folder_ / "out")) {
                EXPECT_EQ(contents(folder_ / "out"), contents(folder_ / "whole"));
            } else {
                const Ended again = run(with(prove("out"), {"--resume"}));
                EXPECT_EQ(again.code, 0) << again.err;
                EXPECT_EQ(contents(folder_ / "out"), contents(folder_ / "whole"));
            }
        });
        EXPECT_GE(faults, 1) << call.name;
        RecordProperty(call.name, faults);
    }
}

TEST_F(Faults, ProofsKilledAtEveryCallGoOn) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    const Words prove{"prove", scene_, "--period", "0", "2", "--quiet"};
    ASSERT_EQ(run(with(prove, {"--out", path("whole")})).code, 0);
    int kills = 0;
    for (const char* call : {"write", "ftruncate", "fsync", "rename"}) {
        for (int number = 1;; number += stride) {
            SCOPED_TRACE(std::string(call) + " " + std::to_string(number));
            fs::remove(folder_ / "out");
            const Words words = with(prove, {"--out", path("out")});
            if (run(words, strace(call, "signal=KILL", number)).code != killed) break;
            ++kills;
            const Ended resumed = run(with(words, {"--resume"}));
            EXPECT_EQ(resumed.code, 0) << resumed.err;
            EXPECT_EQ(contents(folder_ / "out"), contents(folder_ / "whole"));
            EXPECT_FALSE(fs::exists(folder_ / "out.part"));
            if (HasFailure()) return;
        }
    }
    RecordProperty("kills", kills);
    EXPECT_GE(kills, 60 / stride);
}

TEST_F(Faults, ExportKeepsTheTablesThatAreThere) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    (void)run(sweep("whole"));
    fs::copy(folder_ / "whole", folder_ / "out", fs::copy_options::recursive);
    for (const Call& call : outputs) {
        const int faults = each_fault(call, {"export", path("out")}, "nothing", [&](const Ended& ended) {
            expect_orderly(ended, 0);
            expect_tables_of("out");
        });
        RecordProperty(call.name, faults);
    }
    EXPECT_EQ(run({"export", path("out")}).code, 0);
}

TEST_F(Faults, WhatTheCheckerCouldNotReadIsNotValid) {
    if (!can_trace()) GTEST_SKIP() << "no strace, or no right to trace";
    ASSERT_EQ(run({"prove", scene_, "--cells", "14", "--period", "0", "4", "--out", path("proofs"), "--quiet"}).code,
              0);
    ASSERT_GT(fs::file_size(folder_ / "proofs"), 2U << 16U);  // several reads
    Words disturb = strace("read", "error=EIO", 2);
    disturb.insert(disturb.begin() + 1, {"-P", path("proofs")});
    const Ended ended = run({"check", path("proofs")}, disturb);
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.err.find("proofs: line "), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("cannot be read after byte "), std::string::npos) << ended.err;
    EXPECT_EQ(contents(folder_ / ".out").find("valid"), std::string::npos);
}

#ifndef __SANITIZE_ADDRESS__
TEST_F(Faults, AnyAllocationMayFail) {
    const std::string count = path(".count");
    const auto failing = [&](int number) -> Words {
        return {"env", "LD_PRELOAD=" NSMA_FAILING_ALLOCATIONS, "NSMA_FAILING_ALLOCATION=" + std::to_string(number),
                "NSMA_COUNTED_ALLOCATIONS=" + count};
    };
    const Ended whole = run(sweep("whole"), failing(0));
    ASSERT_TRUE(whole.code == 0 || whole.code == 3) << whole.err;
    const int allocations = std::atoi(contents(count).c_str());
    ASSERT_GT(allocations, 1000);
    constexpr int step = 97;  // a prime, as the program repeats itself
    for (int number = 1; number <= allocations; number += step) {
        SCOPED_TRACE("allocation " + std::to_string(number));
        fs::remove_all(folder_ / "out");
        expect_orderly(run(sweep("out"), failing(number)), whole.code);
        const Ended resumed = run(sweep("out", {"--resume"}));
        EXPECT_EQ(resumed.code, whole.code) << resumed.err;
        expect_tables_of("out");
        if (HasFailure()) return;
    }
}
#endif

}  // namespace
