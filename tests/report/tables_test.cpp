#include "report/sweep/tables.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>

#include "sample.hpp"
#include "report/csv.hpp"

namespace nsma {
namespace {

using sample::csv_fields;

PatternRecord admissible_record() {
    PatternRecord record;
    record.pattern = {6, 16, 4};
    record.kernel_dimension = 4;
    record.verdict = Verdict::admissible;
    record.kind = PatternKind::contact;
    record.interval.least = 9.0;
    record.interval.greatest = 36.0;
    return record;
}

TEST(Tables, ScanHasTheAgreedColumns) {
    EXPECT_EQ(scan_csv_header(),
              "cells,gap,free_steps,contact_steps,period_steps,kernel_dimension,frequency_ratio,"
              "verdict,energy_ratio_min,energy_ratio_max,kind");
    EXPECT_EQ(scan_csv_row(Bar{}, admissible_record()), "6,1,16,4,20,4,1.2,admissible,9,36,contact");
}

TEST(Tables, NoValueIsAnEmptyField) {
    PatternRecord record = admissible_record();
    record.interval = nsma::EnergyInterval{};
    record.interval.least = 9.0;
    record.interval.unbounded = true;
    EXPECT_EQ(scan_csv_row(Bar{}, record), "6,1,16,4,20,4,1.2,admissible,9,,contact");
    record.verdict = Verdict::inadmissible;
    record.kind.reset();
    record.interval = {};
    EXPECT_EQ(scan_csv_row(Bar{}, record), "6,1,16,4,20,4,1.2,inadmissible,,,");
}

TEST(Tables, AClosedGapHasNoRatios) {
    Bar bar;
    bar.gap = 0.0;
    PatternRecord record = admissible_record();
    record.gap_sign = 0;
    EXPECT_EQ(scan_csv_row(bar, record), "6,0,16,4,20,4,1.2,admissible,,,contact");
    EXPECT_EQ(
        patterns_csv_row(bar, record),
        "6,0,16,4,20,4,1.2,admissible,,,contact,9,36,false,false,,,,,0.30000000000000004");  // 1/(20 steps of 1/6 s)
}

TEST(Tables, EveryRowHasAsManyFieldsAsItsHeader) {
    const Bar bar;
    const auto fields = [](const std::string& line) { return csv_fields(line).size(); };
    EXPECT_EQ(fields(patterns_csv_row(bar, admissible_record())), fields(patterns_csv_header()));
    OrbitAnswer answer = sample::least_energy_answer(bar, {20, 48, 16});
    EXPECT_EQ(fields(levels_csv_row(bar, answer)), fields(levels_csv_header()));
    answer.solvers = {{"ipopt", 0, "Solve_Succeeded", true, 1.5, 1e-12, 7, 0.01},
                      {"nlopt-slsqp", 1, "XTOL_REACHED", false, 1.6, 0.5, 9, 0.02}};
    answer.reason = "a, b \"c\"\nd";
    const std::string row = levels_csv_row(bar, answer);
    EXPECT_EQ(fields(row), fields(levels_csv_header()));
    // E = 12.5 J = 2 b^2 for waves of one size b = 2.5 m/s: the tip flies at 2b for 1.2 s from the wall, and back.
    EXPECT_THAT(row, testing::EndsWith(
                         ",Solve_Succeeded,1.5,XTOL_REACHED,,false,,,,,contact,false,,,,,0.3125,5,5,5,-5,no bound"));
    EXPECT_EQ(csv_fields(row)[10], "a, b \"c\" d");
    const auto timings = timings_csv_rows(answer);
    ASSERT_EQ(timings.size(), 3U);
    for (const std::string& line : timings) EXPECT_EQ(fields(line), fields(timings_csv_header()));
    OrbitAnswer below;
    below.verdict = Verdict::below;
    below.pattern = {20, 48, 16};
    EXPECT_EQ(fields(levels_csv_row(bar, below)), fields(levels_csv_header()));
}

TEST(Tables, NumbersReadBackToTheSameDouble) {
    std::mt19937_64 random(20160);  // fixed seed
    std::vector<double> values{0.0, 0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -2.5e-17};
    for (int i = 0; i < 10000; ++i) {
        double value = 0;
        const std::uint64_t bits = random();
        std::memcpy(&value, &bits, sizeof value);
        if (std::isfinite(value)) values.push_back(value);
    }
    for (const double value : values) {
        const std::string text = csv_number(value);
        double again = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), again);
        ASSERT_TRUE(error == std::errc() && end == text.data() + text.size()) << text;
        ASSERT_EQ(again, value) << text;
    }
    EXPECT_EQ(csv_number(std::nan("")), "");
    EXPECT_EQ(csv_number(std::numeric_limits<double>::infinity()), "");
}

TEST(Tables, ScanTableIsAligned) {
    PatternRecord open = admissible_record();
    open.interval = EnergyInterval{};
    open.interval.least = 9.0;
    open.interval.unbounded = true;
    std::istringstream lines(scan_table_header(Bar{}) + "\n" + scan_table_row(Bar{}, admissible_record()) + "\n" +
                             scan_table_row(Bar{}, open));
    std::size_t width = 0;
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        if (width == 0) width = line.size();
        EXPECT_EQ(line.size(), width) << line;
    }
    EXPECT_EQ(count, 3);
    EXPECT_THAT(scan_table_row(Bar{}, open), testing::HasSubstr("inf"));
}

TEST(Tables, SummaryNamesEveryCount) {
    SweepSummary summary;
    summary.worst_violation = 1.25e-15;
    const std::string table = summary_table(summary);
    for (const char* word : {"patterns", "trivial", "inadmissible", "admissible", "solved", "agree", "different optima",
                             "failed", "1.25e-15", "time [s]"}) {
        EXPECT_THAT(table, testing::HasSubstr(word));
    }
    summary.interrupted = true;
    EXPECT_THAT(summary_table(summary), testing::StartsWith("interrupted"));
}

/// The closed-form table against the program: data that the program did not make.
TEST(ReferenceTables, BackbonesEqualTheClosedFormOfTheProgram) {
    std::ifstream file(std::filesystem::path(NSMA_DATA) / "mode-backbones.csv");
    std::vector<std::string> names;
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        const auto fields = csv_fields(line);
        if (names.empty()) {
            names = fields;
            continue;
        }
        ASSERT_EQ(fields.size(), names.size()) << line;
        const auto text = [&](const char* name) {
            return fields.at(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
        };
        const auto integer = [&](const char* name) { return std::stoi(text(name)); };
        const Pattern pattern{integer("cells"), integer("free_steps"), integer("contact_steps")};
        EXPECT_EQ(pattern.period_steps(), integer("period_steps"));
        EXPECT_EQ(mode_of(pattern), integer("mode"));
        const double energy = std::stod(text("energy_ratio"));
        // 1e-12: the denominator k^2 T/tau - (2k+1) loses up to 120 units of rounding.
        EXPECT_NEAR(backbone_energy_ratio(integer("mode"), pattern.period_ratio()) / energy, 1.0, 1e-12);
        ++rows;
    }
    EXPECT_GT(rows, 300);
}

}  // namespace
}  // namespace nsma
