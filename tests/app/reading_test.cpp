// The programs of problems/ that read results, where their interpreter is.
#include <array>
#include <cstdio>

#include "program.hpp"

namespace {

struct Interpreter {
    const char* name;
    const char* trial;  ///< succeeds where the interpreter and what the program needs are there
    const char* program;
};

class Reading : public Program, public testing::WithParamInterface<Interpreter> {};

TEST_P(Reading, FindsTheLargestForce) {
    const auto& [name, trial, program] = GetParam();
    const auto shell = [&](const std::string& line) {
        return process::finish(process::start({"sh", "-c", line}, folder_ / ".out", folder_ / ".err"));
    };
    if (shell(std::string(name) + " " + trial) != 0) GTEST_SKIP() << name << " is not here";
    // In SI units; the reasons of rows without an orbit have commas.
    const std::string rod = NSMA_SOURCE "/problems/aluminium-rod.toml";
    ASSERT_EQ(run({"sweep", rod, "--out", path("rod"), "--quiet"}).exit_code, 0);
    double least = 1e300;
    double greatest = 0;
    double largest = -1;
    double energy = 0;
    double frequency_there = 0;
    int orbits = 0;
    for (const std::string& line : process::lines_of(process::contents(folder_ / "rod/orbits.jsonl"))) {
        const auto number = [&line](const std::string& key) {
            return std::stod(line.substr(line.find("\"" + key + "\":") + key.size() + 3));
        };
        if (line.find("\"level\":null") != std::string::npos) continue;
        const double frequency = number("frequency_hz");
        least = std::min(least, frequency);
        greatest = std::max(greatest, frequency);
        ++orbits;
        if (number("peak_force_n") <= largest) continue;
        largest = number("peak_force_n");
        energy = number("energy_joule");
        frequency_there = frequency;
    }
    std::array<char, 200> expected{};
    std::snprintf(expected.data(), expected.size(),
                  "orbits at a level: %d, %.6g to %.6g Hz\nlargest force %.6g N at %.6g J, %.6g Hz\n", orbits, least,
                  greatest, largest, energy, frequency_there);
    EXPECT_EQ(shell(std::string(name) + " '" NSMA_SOURCE "/problems/" + program + "' '" + path("rod") + "'"), 0)
        << process::contents(folder_ / ".err");
    EXPECT_EQ(process::contents(folder_ / ".out"), expected.data());
    EXPECT_GT(orbits, 10);
}

INSTANTIATE_TEST_SUITE_P(Interpreters, Reading,
                         testing::Values(Interpreter{"/usr/bin/python3", "-c 'import numpy'", "read_results.py"},
                                         Interpreter{"octave-cli", "--eval 0", "read_results.m"},
                                         Interpreter{"julia", "-e 0", "read_results.jl"}),
                         [](const auto& one) {
                             const std::string program = one.param.program;
                             return program.substr(program.find('.') + 1);
                         });

}  // namespace
