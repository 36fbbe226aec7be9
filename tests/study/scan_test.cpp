#include "nsma/study/scan.hpp"

#include <vector>

#include <array>

#include <gtest/gtest.h>

namespace {

using nsma::PatternRecord;
using nsma::Scene;
using nsma::Verdict;

Scene six_cells() {
    Scene scene;
    scene.mesh.cells = 6;
    scene.patterns = nsma::PeriodSelection{{0.0, 4.0}, std::nullopt};
    return scene;
}

TEST(Scan, OrderAndPublicCounts) {
    const Scene scene = six_cells();
    std::vector<PatternRecord> records;
    nsma::scan(
        scene, [&](const auto& record) { records.push_back(record); }, [] { return true; });
    const auto patterns = nsma::patterns_of(scene);
    ASSERT_EQ(records.size(), patterns.size());
    int trivial = 0;
    int admissible = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& record = records[i];
        EXPECT_EQ(record.pattern, patterns[i]);
        EXPECT_EQ(record.gap_sign, 1);
        EXPECT_EQ(record.kernel_dimension, nsma::kernel_dimension(record.pattern));
        EXPECT_EQ(record.verdict == Verdict::trivial, record.kernel_dimension == 0);
        EXPECT_EQ(record.interval.least.has_value(), record.verdict == Verdict::admissible);
        if (record.verdict != Verdict::admissible) {
            EXPECT_FALSE(record.reason.empty());
        }
        EXPECT_GE(record.seconds, 0.0);
        if (record.verdict == Verdict::trivial) ++trivial;
        if (record.verdict == Verdict::admissible) ++admissible;
    }
    EXPECT_EQ(records.size(), 276U);
    EXPECT_EQ(trivial, 276 - 209);
    EXPECT_EQ(admissible, 35);
}

TEST(Scan, EveryMethodGivesTheSameVerdictsAndIntervals) {
    for (const double gap : {1.0, -1.0, 0.0}) {
        Scene scene = six_cells();
        scene.bar.gap = gap;
        std::vector<PatternRecord> certified;
        nsma::scan(
            scene, [&](const auto& record) { certified.push_back(record); }, [] { return true; });
        std::size_t i = 0;
        nsma::scan(
            scene,
            [&](const auto& record) {
                const PatternRecord& other = certified[i++];
                EXPECT_EQ(record.pattern, other.pattern);
                EXPECT_EQ(record.verdict, other.verdict) << record.reason;
                EXPECT_EQ(record.kind, other.kind);
                EXPECT_EQ(record.kernel_dimension, other.kernel_dimension);
                EXPECT_EQ(record.interval.unbounded, other.interval.unbounded);
                EXPECT_EQ(record.interval.least, other.interval.least);  // both exact, rounded once
                if (!other.interval.greatest_exact.empty()) {
                    EXPECT_EQ(record.interval.greatest, other.interval.greatest);
                }
            },
            [] { return true; }, nsma::ScanMethod::integers);
        EXPECT_EQ(i, certified.size());
    }
}

// Counts of a program that shares nothing with this one.
TEST(Scan, KindsAreThoseOfAnIndependentCount) {
    struct Count {
        int cells;
        double gap;
        int admissible, contact, free, stuck;
    };
    for (const Count& count : {Count{6, 1, 35, 18, 17, 0}, Count{8, 1, 38, 23, 15, 0}, Count{8, -1, 98, 34, 0, 64},
                               Count{6, 0, 20, 20, 0, 0}}) {
        Scene scene = six_cells();
        scene.mesh.cells = count.cells;
        scene.bar.gap = count.gap;
        std::array<int, 3> kinds{};
        int admissible = 0;
        nsma::scan(
            scene,
            [&](const auto& record) {
                EXPECT_TRUE(record.proved) << record.reason;
                EXPECT_EQ(record.kind.has_value(), record.verdict == Verdict::admissible);
                if (!record.kind) return;
                ++admissible;
                ++kinds.at(static_cast<std::size_t>(*record.kind));
            },
            [] { return true; });
        EXPECT_EQ(admissible, count.admissible) << count.cells << ' ' << count.gap;
        EXPECT_EQ(kinds, (std::array<int, 3>{count.contact, count.free, count.stuck}))
            << count.cells << ' ' << count.gap;
    }
}

TEST(Scan, StopsBeforeTheNextPattern) {
    int asked = 0;
    int seen = 0;
    nsma::scan(
        six_cells(), [&](const auto&) { ++seen; }, [&] { return ++asked <= 5; });
    EXPECT_EQ(seen, 5);
    EXPECT_EQ(asked, 6);
}

TEST(Scan, UsesTheSignOfTheGap) {
    Scene scene = six_cells();
    scene.patterns = nsma::ListSelection{{{16, 4}}};
    for (const auto& [gap, verdict] :
         {std::pair{0.3, Verdict::admissible}, {-0.3, Verdict::inadmissible}, {0.0, Verdict::inadmissible}}) {
        scene.bar.gap = gap;
        nsma::scan(
            scene, [&, at = gap, want = verdict](const auto& record) { EXPECT_EQ(record.verdict, want) << at; },
            [] { return true; });
    }
}

}  // namespace
