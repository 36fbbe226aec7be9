// `nsma scan`, `prove` and `check`: verdicts and their proofs.
#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using process::contents;
using process::lines_of;

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

TEST_F(Program, ScanMethodsAgreeToTheByte) {
    const Words words{"scan", scene_, "--cells", "8", "--period", "0", "4", "--csv", "--quiet"};
    const Result certified = run(words);
    EXPECT_EQ(certified.exit_code, 0);
    EXPECT_EQ(run(with(words, {"--method", "integers"})).out, certified.out);
    const auto lines = lines_of(certified.out);
    EXPECT_EQ(
        std::count_if(lines.begin(), lines.end(), [](const std::string& line) { return line.ends_with(",contact"); }),
        23);
    EXPECT_EQ(
        std::count_if(lines.begin(), lines.end(), [](const std::string& line) { return line.ends_with(",free"); }), 15);
    expect_refused({"scan", scene_, "--method", "magic"}, "--method");
}

TEST_F(Program, BestOrbitsAreCertifiedAtAnEnergy) {
    const Words words{"prove", scene_, "--cells", "6", "--period", "0", "4", "--energy", "12", "--quiet", "--out"};
    for (const std::string objective : {"least-shock", "least-force"}) {
        const Result proved = run(with(words, {path(objective), "--objective", objective}));
        EXPECT_EQ(proved.exit_code, 0) << proved.err;
        EXPECT_NE(proved.out.find(" best orbits proved, largest gap "), std::string::npos) << proved.out;
        const Result checked = run({"check", path(objective)});
        EXPECT_EQ(checked.exit_code, 0) << checked.out;
        EXPECT_NE(checked.out.find(" best orbits among them, largest gap "), std::string::npos) << checked.out;
    }
    // What a run for one objective left is not gone on with for the other, nor without optima where they are asked.
    for (const auto& [kept, expected] : {std::pair{contents(path("least-force")), "no optimum of another objective"},
                                         std::pair{std::string(), "an optimum of"}}) {
        std::string text = kept;
        if (text.empty()) {
            ASSERT_EQ(run({"prove", scene_, "--period", "0", "4", "--quiet", "--out", path("plain")}).exit_code, 0);
            text = contents(path("plain"));
        }
        write("resumed.part", text);
        const Result resumed = run(with(words, {path("resumed"), "--objective", "least-shock", "--resume"}));
        EXPECT_EQ(resumed.exit_code, 2);
        EXPECT_NE(resumed.err.find(expected), std::string::npos) << resumed.err;
        EXPECT_EQ(contents(path("resumed.part")), text);
    }
    // A bound that is raised is refused.
    std::string forged = contents(path("least-shock"));
    const auto at = forged.find("\"bound\":\"") + 9;
    forged.replace(at, 1, forged[at] == '9' ? "99" : std::string(1, static_cast<char>(forged[at] + 1)));
    const Result rejected = run({"check", write("forged.jsonl", forged)});
    EXPECT_EQ(rejected.exit_code, 4);
    EXPECT_NE(rejected.out.find("rejected: optimum: proved only "), std::string::npos) << rejected.out;
    expect_refused(with(words, {path("none"), "--objective", "nearest"}),
                   "--objective: expected least-shock or least-force");
}

TEST_F(Program, CertificatesAreWrittenAndVerified) {
    const std::string proofs = path("proofs.jsonl");
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
    const std::string before = contents(proofs);

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
    old.replace(old.find(":3,"), 3, ":1,");
    expect_refused({"check", write("old.jsonl", old + "\n")}, "expected 3, got 1");
}

class Proofs : public Program {
protected:
    [[nodiscard]] Words prove(const Words& more = {}) const {
        return with({"prove", scene_, "--period", "0", "4", "--out", proofs_, "--quiet"}, more);
    }
    /// Refused, and the file as it was.
    void expect_kept(const std::string& file, const Words& words, const std::string& named) const {
        const std::string before = contents(file);
        expect_refused(words, file + ": " + named);
        EXPECT_EQ(contents(file), before);
    }

    const std::string proofs_ = path("proofs.jsonl");
    const std::string part_ = proofs_ + ".part";
};

TEST_F(Proofs, OnlyCertificatesOfTheSamePatternsAreReplaced) {
    ASSERT_EQ(run(prove()).exit_code, 0);
    const std::string whole = contents(proofs_);
    // Again, and instead of a few of its certificates, in any order, or of none.
    const auto lines = lines_of(whole);
    for (const std::string& old : {whole, lines[200] + "\n" + lines[3] + "\n", std::string()}) {
        write("proofs.jsonl", old);
        EXPECT_EQ(run(prove()).exit_code, 0);
        EXPECT_EQ(contents(proofs_), whole);
    }
    EXPECT_FALSE(fs::exists(part_));

    const std::string others = "holds more than certificates of this run (line ";
    expect_kept(proofs_, {"prove", scene_, "--out", proofs_}, others + "1: expected a pattern of this run");
    expect_kept(proofs_, prove({"--gap", "-1"}), others + "1: expected a pattern of this run, got (6, 1, 1, 1))");
    expect_kept(proofs_, prove({"--cells", "5"}), others + "1: ");
    expect_kept(proofs_, prove({"--fresh", "--cells", "5"}), others + "1: ");
    write("proofs.jsonl", lines[0] + "\nhello\n");
    expect_kept(proofs_, prove(), others + "2: expected one JSON object a line");
    fs::create_directory(path("folder"));
    expect_refused({"prove", scene_, "--out", path("folder")}, "folder: expected a file of certificates");
    expect_refused({"prove", scene_, "--out", "/dev/null"}, "/dev/null: expected a file of certificates");
}

TEST_F(Proofs, AnInterruptedRunGoesOnFromAnyByte) {
    ASSERT_EQ(run(prove()).exit_code, 0);
    const std::string whole = contents(proofs_);
    fs::remove(proofs_);
    const std::size_t first = whole.find('\n');
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, first, first + 1, whole.size() / 2, whole.size() - 1, whole.size()}) {
        SCOPED_TRACE(size);
        write("proofs.jsonl.part", whole.substr(0, size));
        expect_kept(part_, prove(), "is an interrupted run: expected --resume to go on with it or --fresh");
        const Result resumed = run(prove({"--resume"}));
        EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
        EXPECT_NE(resumed.out.find("276 patterns, 276 proved; 35 admissible (18 contact, 17 free, 0 stuck), greatest "
                                   "energy exact for 35\n"),
                  std::string::npos)
            << resumed.out;
        EXPECT_EQ(contents(proofs_), whole);
        EXPECT_FALSE(fs::exists(part_));
        fs::remove(proofs_);
    }
    write("proofs.jsonl.part", "anything");
    EXPECT_EQ(run(prove({"--fresh"})).exit_code, 0);
    EXPECT_EQ(contents(proofs_), whole);
    EXPECT_EQ(run(prove({"--resume"})).exit_code, 0);  // nothing to go on with
    EXPECT_EQ(contents(proofs_), whole);
}

TEST_F(Proofs, WhatAnotherRunLeftIsNotGoneOnWith) {
    ASSERT_EQ(run(prove()).exit_code, 0);
    const auto lines = lines_of(contents(proofs_));
    fs::remove(proofs_);
    const auto expect_other = [&](const std::string& text, const Words& words, const std::string& named) {
        write("proofs.jsonl.part", text);
        expect_kept(part_, with(words, {"--resume"}), "is of another run (line " + named);
    };
    const std::string two = lines[0] + "\n" + lines[1] + "\n";
    expect_other(two, prove({"--cells", "5"}), "1: expected a certificate of (5, 1, 1, 1), got (6, 1, 1, 1))");
    expect_other(two, prove({"--gap", "-1"}), "1: expected a certificate of (6, 1, 1, -1), got (6, 1, 1, 1))");
    expect_other(lines[1] + "\n" + lines[0] + "\n", prove(), "1: expected a certificate of (6, 1, 1, 1), got (6, ");
    write("proofs.jsonl.part", "hello\n" + two);
    expect_kept(part_, prove({"--resume"}), "is damaged (line 1: expected one JSON object a line");
    const Words one{"prove", scene_, "--free", "1", "--contact", "1", "--out", proofs_};
    expect_other(two, one, "2: expected no more certificates, got ");
    std::string forged = lines[0];
    forged.replace(forged.find("empty"), 5, "trivial");
    expect_other(forged + "\n", prove(), "1: expected a proof, got one that fails: ");
}

TEST_F(Proofs, InterruptedProofsAreNotTakenForWhole) {
    const Words words = prove({"--cells", "48"});
    ASSERT_EQ(run(words).exit_code, 0);
    const std::string whole = contents(proofs_);
    fs::remove(proofs_);
    const pid_t child = start(words);
    process::wait_for(
        [&] {
            std::error_code code;
            return fs::file_size(part_, code) > 100'000 && !code;
        },
        24);
    kill(child, SIGINT);
    const Result result = finish(child);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_FALSE(fs::exists(proofs_));
    EXPECT_NE(result.out.find("interrupted: those so far are in " + part_), std::string::npos) << result.out;
    EXPECT_EQ(run({"check", part_}).exit_code, 0);  // whole lines
    EXPECT_EQ(run(with(words, {"--resume"})).exit_code, 0);
    EXPECT_EQ(contents(proofs_), whole);
}

}  // namespace
