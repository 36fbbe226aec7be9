#include "study/accuracy/accuracy.hpp"

#include <map>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "nsma/orbit/backbone.hpp"
#include "numerics/solver.hpp"
#include "study/accuracy/program_methods.hpp"

namespace {

using nsma::Outcome;

// Runs a quick study of a scene, of so many pieces of work at most.
bool quick_study(const nsma::Scene& scene, nsma::AccuracyResults& seen, long pieces = 1'000'000) {
    return nsma::accuracy(
        scene, true, [&](const nsma::AccuracyRecord& record) { seen.add(record); },
        [&](long done, long total) {
            EXPECT_LE(done, total);
            return pieces-- > 0;
        });
}

nsma::Scene unit_scene(double gap) {
    nsma::Scene scene;
    scene.bar.gap = gap;
    return scene;
}

TEST(Accuracy, PatternsHaveTheSizeAskedAndOneLeastEnergy) {
    for (const int sign : {1, -1}) {
        for (const int size : {2, 8, 32, 128}) {
            const nsma::Pattern pattern = nsma::accuracy_pattern(size, sign);
            EXPECT_EQ(nsma::kernel_dimension(pattern), size);
            EXPECT_EQ(nsma::mode_of(pattern), 1);
            EXPECT_NEAR(nsma::backbone_energy_ratio(1, pattern.period_ratio()), 25.0, 1e-9);  // 1/0.2^2
        }
        EXPECT_THROW((void)nsma::accuracy_pattern(3, sign), std::invalid_argument);
    }
    EXPECT_THROW((void)nsma::accuracy_pattern(2, 0), std::invalid_argument);
}

TEST(Accuracy, SpreadIsTheMedianAndTheQuartiles) {
    const nsma::Spread five = nsma::spread({5, 1, 4, 2, 3});
    EXPECT_EQ(five.median, 3);
    EXPECT_EQ(five.low, 2);
    EXPECT_EQ(five.high, 4);
    EXPECT_EQ(nsma::spread({7}).median, 7);
    EXPECT_EQ(nsma::spread({1, 2}).median, 1.5);
    EXPECT_THROW((void)nsma::spread({}), std::invalid_argument);
}

TEST(Accuracy, QuickRunEndToEnd) {
    nsma::AccuracyResults seen;
    ASSERT_TRUE(quick_study(unit_scene(1.0), seen));

    std::set<std::string> methods;
    for (const auto& record : seen.programs) {
        methods.insert(record.method);
        EXPECT_TRUE(record.proved) << record.size;  // every reference is certified
        EXPECT_GT(record.runs, 0);
        if (record.method != "both solvers") continue;
        EXPECT_EQ(record.succeeded(), record.runs);
        EXPECT_LE(record.error, 1e-9);
    }
    EXPECT_EQ(methods, (std::set<std::string>{"both solvers", "default", "segment", "Ipopt", "SLSQP", "AUGLAG+LBFGS",
                                              "AUGLAG+SLSQP", "COBYLA", "ISRES"}));
    for (const auto& record : seen.kernels) {
        EXPECT_EQ(record.dimension, record.expected) << record.method;
        EXPECT_LE(record.error, 1e-12) << record.method;  // rounding at N = 20
    }
    for (const auto& record : seen.marches) {
        const bool exact = record.method.rfind("FE", 0) != 0;
        EXPECT_LE(record.tip_error, exact ? 1e-12 : 2.0) << record.method;
        if (exact) {
            EXPECT_EQ(record.contact_error, 0.0);
        }
    }
    for (const auto& record : seen.drifts) {
        if (record.method == "wave queue") {
            EXPECT_LE(record.energy_drift, 1e-15);  // rounding of the sum alone
            EXPECT_LE(record.periodicity_defect, 1e-15);
        }
    }
    std::set<std::string> maps;
    for (const auto& record : seen.stability) {
        maps.insert(record.map);
        if (record.map == "level") {
            EXPECT_TRUE(record.proved) << record.size << ' ' << record.difficulty;
        }
        // Where an answer is proved to exist the default path finds it.
        if (record.method == "both solvers" || record.method == "default") {
            EXPECT_EQ(record.outcomes[0], record.runs) << record.map << ' ' << record.difficulty;
        }
        EXPECT_LE(record.false_success, record.reported);
    }
    EXPECT_EQ(maps, (std::set<std::string>{"level", "start", "units", "rows"}));
    EXPECT_FALSE(seen.tolerances.empty());
}

TEST(Accuracy, TheWholePathsSucceedInEveryCellOfAReducedMap) {
    for (const int sign : {1, -1}) {
        nsma::Bar bar;
        bar.gap = sign;
        for (const int size : {2, 4, 8}) {
            const auto problem = nsma::pattern_problem(nsma::accuracy_pattern(size, sign), sign);
            EXPECT_EQ(problem.kind, nsma::PatternKind::contact);
            const double least = *problem.interval.least;
            const double greatest = *problem.interval.greatest;
            for (const double level : {least * (1 + 1e-10), least * (1 + 1e-4), 0.5 * (least + greatest),
                                       greatest * (1 - 1e-4), greatest * (1 - 1e-10)}) {
                const auto on = nsma::solved_case(bar, problem, nsma::Objective::least_shock, level);
                EXPECT_TRUE(on.proved) << size << ' ' << level;
                int whole = 0;
                for (const auto& method : nsma::program_methods(true)) {
                    if (!method.whole()) continue;
                    ++whole;
                    nsma::MethodRunner runner(method);
                    const nsma::Trial trial = runner.run(on, on.program.program, on.best_x);
                    EXPECT_EQ(trial.outcome, Outcome::success) << size << ' ' << level;
                    EXPECT_TRUE(trial.certified) << size << ' ' << level;
                    EXPECT_LE(trial.error(), 1e-9);
                    // The default knows the answer; a cross-check has really asked both, at two amplitudes too.
                    EXPECT_EQ(trial.iterations > 0, method.kind == nsma::ProgramMethod::Kind::both)
                        << size << ' ' << level;
                }
                EXPECT_EQ(whole, 2);
            }
        }
    }
}

TEST(Accuracy, ReferencesAreProvedAtEverySizeAndProofFirstComesToThem) {
#ifdef __SANITIZE_ADDRESS__
    const std::vector<int> sizes{2, 8};
#else
    const std::vector<int> sizes{2, 8, 32, 128};
#endif
    const nsma::Bar bar;
    for (const int size : sizes) {
        const auto problem = nsma::pattern_problem(nsma::accuracy_pattern(size, 1), 1);
        for (const double level :
             {1.1 * *problem.interval.least, 1.3 * *problem.interval.least, 0.8 * *problem.interval.greatest}) {
            const auto on = nsma::solved_case(bar, problem, nsma::Objective::least_shock, level);
            EXPECT_TRUE(on.proved) << size << ' ' << level;
            for (const auto& method : nsma::program_methods(true)) {
                if (method.kind != nsma::ProgramMethod::Kind::proof) continue;
                nsma::MethodRunner runner(method);
                const nsma::Trial trial = runner.run(on, on.program.program, on.best_x);
                EXPECT_EQ(trial.outcome, Outcome::success) << size << ' ' << level;
                EXPECT_TRUE(trial.certified) << size << ' ' << level;
            }
        }
        // Two neighbours are left at 0.8 E_max: x + y = 1, x^2 + y^2 = q, and a run costs x^2 + y^2 + (x - y)^2 = 3 q -
        // 1, so 2N R (3 q - 1) with R = 8 runs a period.
        if (size == 2) continue;  // they are neighbours on both sides there
        const auto top =
            nsma::solved_case(bar, problem, nsma::Objective::least_shock, 0.8 * *problem.interval.greatest);
        const double exact = 2.0 * (2.5 * size) * 8.0 * (3.0 * 0.8 - 1.0);
        EXPECT_NEAR(top.best, exact, 1e-9 * exact) << size;
    }
}

TEST(Accuracy, RawAnswersAreJudgedByReplayNotByTheirStatus) {
    nsma::Bar bar;
    const auto problem = nsma::pattern_problem(nsma::accuracy_pattern(8, 1), 1);
    const auto on = nsma::solved_case(bar, problem, nsma::Objective::least_shock, 1.3 * *problem.interval.least);
    nsma::ProgramMethod loose{.kind = nsma::ProgramMethod::Kind::ipopt, .tolerance = 1e-3, .polish = false};
    nsma::MethodRunner raw(loose);
    const auto start = on.program.point(on.points.start(0).value());
    const nsma::Trial refused = raw.run(on, on.program.program, start);
    EXPECT_TRUE(refused.reported);
    EXPECT_NE(refused.outcome, Outcome::success);  // its residuals are of the order of its tolerance
    loose.polish = true;
    nsma::MethodRunner polished(loose);
    EXPECT_EQ(polished.run(on, on.program.program, start).outcome, Outcome::success);
}

TEST(Accuracy, StopsWhenToldAndRefusesAClosedGap) {
    nsma::AccuracyResults seen;
    EXPECT_FALSE(quick_study(unit_scene(1.0), seen, 3));
    EXPECT_TRUE(seen.programs.empty());
    EXPECT_THROW((void)quick_study(unit_scene(0.0), seen), std::invalid_argument);
    nsma::Scene extreme = unit_scene(1.0);
    extreme.objective = nsma::Objective::max_energy;
    EXPECT_THROW((void)quick_study(extreme, seen), std::invalid_argument);
}

}  // namespace
