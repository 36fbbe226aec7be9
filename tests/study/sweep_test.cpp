#include "run_sweep.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace {

using nsma::Objective;
using nsma::OrbitAnswer;
using nsma::Pattern;
using nsma::PatternRecord;
using nsma::Scene;
using nsma::SweepSummary;
using nsma::Verdict;

/// Keeps every record and checks the order in which they come.
class Recorder : public nsma::SweepSink {
public:
    void pattern(const PatternRecord& record) override { patterns.push_back(record); }
    void answer(const OrbitAnswer& answer) override {
        ASSERT_FALSE(patterns.empty());
        EXPECT_EQ(patterns.back().pattern, answer.pattern);  // its pattern has just been told
        EXPECT_EQ(patterns.back().verdict, Verdict::admissible);
        answers.push_back(answer);
    }
    void progress(long done, long total) override {
        EXPECT_GT(done, last_done);
        EXPECT_LE(done, total);
        last_done = done;
        last_total = total;
    }

    std::vector<PatternRecord> patterns;
    std::vector<OrbitAnswer> answers;
    long last_done = 0;
    long last_total = 0;
};

Scene small_scene() {
    Scene scene;
    scene.mesh.cells = 4;
    scene.patterns = nsma::PeriodSelection{{0.0, 4.0}, std::nullopt};
    scene.levels = {0.5, 1.6, 6.0, 300.0};
    return scene;
}

bool always() { return true; }

/// The counts recomputed from the records.
void expect_counts(const SweepSummary& summary, const Recorder& seen) {
    const auto patterns = [&](Verdict verdict) {
        return static_cast<int>(std::count_if(seen.patterns.begin(), seen.patterns.end(),
                                              [&](const auto& record) { return record.verdict == verdict; }));
    };
    EXPECT_EQ(summary.patterns, static_cast<int>(seen.patterns.size()));
    EXPECT_EQ(summary.trivial, patterns(Verdict::trivial));
    EXPECT_EQ(summary.inadmissible, patterns(Verdict::inadmissible));
    EXPECT_EQ(summary.admissible, patterns(Verdict::admissible));
    EXPECT_EQ(summary.failed_patterns, patterns(Verdict::failed));
    for (const auto kind : nsma::pattern_kinds) {
        EXPECT_EQ(summary.kinds[static_cast<std::size_t>(kind)],
                  std::count_if(seen.patterns.begin(), seen.patterns.end(),
                                [&](const auto& record) { return record.kind == kind; }));
    }
    EXPECT_EQ(summary.patterns, summary.trivial + summary.inadmissible + summary.admissible + summary.failed_patterns);
    std::map<Verdict, int> levels;
    double worst = 0;
    int asked = 0;
    for (const auto& answer : seen.answers) {
        if (answer.replay) worst = std::max(worst, answer.replay->violations.worst());
        if (!answer.level) continue;
        ++asked;
        ++levels[answer.verdict];
    }
    EXPECT_EQ(summary.levels, asked);
    EXPECT_EQ(summary.solved, levels[Verdict::admissible]);
    EXPECT_EQ(summary.below, levels[Verdict::below]);
    EXPECT_EQ(summary.above, levels[Verdict::above]);
    EXPECT_EQ(summary.levels, summary.solved + summary.below + summary.above + summary.failed);
    EXPECT_EQ(summary.solved, summary.closed_form + summary.agreed + summary.disagreed + summary.one_failed);
    EXPECT_EQ(summary.worst_violation, worst);
    EXPECT_LE(summary.worst_violation, 1e-9);
}

TEST(Sweep, EveryPatternAndLevelOnce) {
    const Scene scene = small_scene();
    Recorder seen;
    const auto summary = nsma::sweep(scene, {}, seen, always);
    const auto patterns = nsma::patterns_of(scene);
    ASSERT_EQ(seen.patterns.size(), patterns.size());
    for (std::size_t i = 0; i < patterns.size(); ++i) EXPECT_EQ(seen.patterns[i].pattern, patterns[i]);
    std::size_t i = 0;
    for (const auto& record : seen.patterns) {
        if (!nsma::is_solved(scene.all_kinds, record.kind)) continue;
        ASSERT_LE(i + 1 + scene.levels.size(), seen.answers.size());
        EXPECT_EQ(seen.answers[i].pattern, record.pattern);
        EXPECT_FALSE(seen.answers[i].level);  // the least-energy orbit comes first
        EXPECT_NEAR(*seen.answers[i].energy, *record.interval.least, 1e-12 * *record.interval.least);
        ++i;
        for (const double level : scene.levels) EXPECT_EQ(seen.answers[i++].level, level);
    }
    EXPECT_EQ(i, seen.answers.size());
    EXPECT_FALSE(summary.interrupted);
    EXPECT_GT(summary.solved, 0);
    EXPECT_GT(summary.below, 0);
    EXPECT_GT(summary.above, 0);
    EXPECT_EQ(seen.last_done, seen.last_total);
    expect_counts(summary, seen);
}

TEST(Sweep, InterruptionGoesNoFurther) {
    const Scene scene = small_scene();
    Recorder all;
    (void)nsma::sweep(scene, {}, all, always);
    for (const int allowed : {0, 1, 30, 60}) {
        Recorder seen;
        int asked = 0;
        const auto summary = nsma::sweep(scene, {}, seen, [&] { return ++asked <= allowed; });
        EXPECT_TRUE(summary.interrupted);
        EXPECT_EQ(asked, allowed + 1);  // never asked again after a no
        EXPECT_EQ(static_cast<int>(seen.patterns.size() + seen.answers.size()), allowed);  // one ask a record
        // What there is, is the beginning of the whole.
        for (std::size_t i = 0; i < seen.answers.size(); ++i) {
            EXPECT_EQ(seen.answers[i].pattern, all.answers[i].pattern);
            EXPECT_EQ(seen.answers[i].level, all.answers[i].level);
            ASSERT_EQ(seen.answers[i].orbit.has_value(), all.answers[i].orbit.has_value());
            if (seen.answers[i].orbit) {
                EXPECT_EQ(seen.answers[i].orbit->beta, all.answers[i].orbit->beta);
            }
        }
        expect_counts(summary, seen);
    }
}

TEST(Sweep, NearestFollowsThePreviousLevel) {
    Scene scene = small_scene();
    scene.mesh.cells = 6;
    scene.patterns = nsma::ListSelection{{{16, 4}}};
    scene.objective = Objective::nearest;
    scene.levels = {10.0, 20.0, 30.0};
    Recorder seen;
    const auto summary = nsma::sweep(scene, {}, seen, always);
    ASSERT_EQ(seen.answers.size(), 4U);
    expect_counts(summary, seen);
    for (std::size_t i = 1; i < 4; ++i) {
        ASSERT_TRUE(seen.answers[i].orbit);
        EXPECT_EQ(seen.answers[i].objective, Objective::nearest);
        // The value is the energy of the difference to the orbit of the level before.
        const auto& before = *seen.answers[i - 1].orbit;
        const auto& here = *seen.answers[i].orbit;
        const nsma::State difference = nsma::initial_state(here) - nsma::initial_state(before);
        const double distance = nsma::energy(here.bar, here.mesh(), difference) / here.bar.energy_unit();
        EXPECT_NEAR(*seen.answers[i].objective_value, distance, 1e-10 * (1 + distance));  // sums of squares
    }
}

TEST(Sweep, ExtremesHaveOneAnswerAPatternAndNoLevel) {
    for (const auto objective : {Objective::min_energy, Objective::max_energy}) {
        Scene scene = small_scene();
        scene.objective = objective;
        Recorder seen;
        const auto summary = nsma::sweep(scene, {}, seen, always);
        EXPECT_EQ(static_cast<int>(seen.answers.size()), summary.admissible - summary.left);
        EXPECT_EQ(summary.levels, summary.admissible - summary.left);
        std::map<std::pair<int, int>, nsma::EnergyInterval> intervals;
        for (const auto& record : seen.patterns) {
            intervals[{record.pattern.free_steps, record.pattern.contact_steps}] = record.interval;
        }
        for (const auto& answer : seen.answers) {
            EXPECT_FALSE(answer.level);
            ASSERT_EQ(answer.verdict, Verdict::admissible) << answer.reason;
            const auto& interval = intervals[{answer.pattern.free_steps, answer.pattern.contact_steps}];
            const double end = objective == Objective::min_energy ? *interval.least : *interval.greatest;
            EXPECT_NEAR(*answer.energy, end, 1e-9 * end);  // stationarity of the polish
        }
    }
}

TEST(Sweep, ClosedGapHasNoLeastEnergyOrbit) {
    Scene scene = small_scene();
    scene.bar.gap = 0;
    scene.patterns = nsma::ModeSelection{1};
    scene.levels = {1e-3, 2.0};
    Recorder seen;
    const auto summary = nsma::sweep(scene, {}, seen, always);
    ASSERT_EQ(seen.patterns.size(), 1U);  // (8, 4)
    ASSERT_EQ(seen.answers.size(), 2U);
    for (const auto& answer : seen.answers) EXPECT_TRUE(answer.level.has_value());
    EXPECT_EQ(summary.solved, 2);
    expect_counts(summary, seen);
}

TEST(Sweep, EmptySceneIsAnEmptySummary) {
    Scene scene = small_scene();
    scene.patterns = nsma::ListSelection{};
    Recorder seen;
    const auto summary = nsma::sweep(scene, {}, seen, always);
    EXPECT_EQ(summary.patterns, 0);
    EXPECT_EQ(summary.levels, 0);
    EXPECT_FALSE(summary.interrupted);
}

}  // namespace
