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
    const std::string proofs = path("proofs.jsonl");
    const pid_t child = start({"prove", scene_, "--cells", "200", "--period", "0", "4", "--out", proofs, "--quiet"});
    process::wait_for(
        [&] {
            std::error_code code;
            return fs::file_size(proofs + ".part", code) > 100'000 && !code;
        },
        24);
    kill(child, SIGINT);
    const Result result = finish(child);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_FALSE(fs::exists(proofs));
    EXPECT_NE(result.out.find("interrupted: those so far are in " + proofs + ".part"), std::string::npos) << result.out;
    EXPECT_EQ(run({"check", proofs + ".part"}).exit_code, 0);  // whole lines
}

}  // namespace
