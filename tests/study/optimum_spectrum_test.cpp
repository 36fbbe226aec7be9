// Every level of whole small spectra against searches that look everywhere: simplexes through all of their faces,
// chains from many starts. Shares nothing with the solver but the pattern. NSMA_LONG_TESTS=1 goes up to N = 6.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "../search/literal_program.hpp"
#include "../search/simplex_reference.hpp"

#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/study/sensitivity/sensitivity.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using nsma::Objective;
using nsma::Pattern;
using nsma::PatternKind;

struct Subject {
    nsma::Bar bar;
    nsma::PatternProblem problem;
    std::vector<double> levels;
};

template <typename Visit>
void for_each_pattern(int cells_lo, int cells_hi, Visit visit) {
    for (int cells = cells_lo; cells <= cells_hi; ++cells) {
        for (const Pattern& pattern : nsma::patterns_in(cells, {2, 4 * cells, 1, nsma::max_period_steps})) {
            for (const int gap_sign : {1, -1, 0}) {
                Subject subject{{}, nsma::pattern_problem(pattern, gap_sign, {.prove = false}), {}};
                if (subject.problem.verdict != nsma::Verdict::admissible || subject.problem.kernel.dimension() < 2)
                    continue;
                subject.bar.gap = gap_sign;
                const auto& interval = subject.problem.interval;
                for (const double share : {1e-3, 0.2, 0.55, 0.9}) {
                    subject.levels.push_back(
                        gap_sign == 0 ? 1 + share : *interval.least + share * (*interval.greatest - *interval.least));
                }
                visit(subject);
            }
        }
    }
}

// A target that is no orbit of the set and tells its columns apart.
VectorXd target_window(const Subject& subject, double part) {
    const auto& problem = subject.problem;
    VectorXd gamma(problem.set.reduction.variables());
    for (Eigen::Index j = 0; j < gamma.size(); ++j)
        gamma[j] = part * (std::fmod(0.37 * static_cast<double>(j + 1), 1.0) - 0.2);
    return nsma::reference_window(nsma::make_orbit(subject.bar, problem.kernel, problem.set.reduction.beta(gamma)));
}

TEST(OptimumSpectrum, SimplexesHaveTheBestOfAllTheirFaces) {
    const bool longer = std::getenv("NSMA_LONG_TESTS") != nullptr;
#ifdef __SANITIZE_ADDRESS__
    const int most = longer ? 6 : 3;
#else
    const int most = longer ? 8 : 4;
#endif
    int compared = 0, stuck = 0;
    double worst = 0;
    nsma::OrbitSolver solver;
    for_each_pattern(1, most, [&](const Subject& subject) {
        const auto& problem = subject.problem;
        if (problem.kind == PatternKind::free || problem.kernel.dimension() > 7) return;
        const Pattern& pattern = problem.kernel.pattern;
        const int gap_sign = subject.bar.gap_sign();
        // Signs and the sum of the amplitudes, from the scheme.
        const literal::Program plain(pattern, gap_sign, Objective::least_shock, {});
        VectorXd signs = VectorXd::Zero(plain.dimension());
        for (int n = pattern.free_steps; n < pattern.period_steps(); ++n) signs += plain.wave(n).transpose();
        signs = signs.cwiseSign();
        VectorXd tip = VectorXd::Zero(plain.dimension());
        for (int k = 0; k < 2 * pattern.cells; ++k) tip -= plain.wave(k).transpose();
        const double weight = tip.cwiseProduct(signs)[0];
        const double sum = gap_sign == 0 ? 0.0 : gap_sign / weight;
        const double unit = 4.0 * pattern.cells * pattern.cells / pattern.class_count();
        for (const double level : subject.levels) {
            for (const auto objective : {Objective::least_shock, Objective::nearest, Objective::least_force}) {
                nsma::OrbitRequest request{level, objective, {}, {}};
                if (objective == Objective::nearest) request.reference = target_window(subject, 0.7);
                const auto answer = solver.solve(subject.bar, problem, request);
                SCOPED_TRACE(testing::Message()
                             << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps << ") gap "
                             << gap_sign << " " << nsma::name(objective) << " at " << level);
                ASSERT_EQ(answer.verdict, nsma::Verdict::admissible) << answer.reason;
                ASSERT_TRUE(answer.optimality && answer.optimality->global);
                EXPECT_LE(answer.replay->violations.worst(), 1e-9);
                const literal::Program program(pattern, gap_sign, objective, request.reference);
                EXPECT_NEAR(program.value(answer.orbit->beta), *answer.objective_value,
                            1e-12 * (level + *answer.objective_value));
                double expected = 0;
                const double square = level / unit;
                if (objective == Objective::least_force) {
                    expected = 2 * pattern.cells * reference::least_peak(plain.dimension(), sum, square);
                } else if (objective == Objective::least_shock) {
                    const MatrixXd a = signs.asDiagonal() * program.shock() * signs.asDiagonal();
                    expected = reference::least(a, VectorXd::Zero(signs.size()), sum, square).value;
                } else {
                    const VectorXd c = -program.target().cwiseProduct(signs);
                    const MatrixXd a = MatrixXd::Zero(signs.size(), signs.size());
                    expected = level + 2 * pattern.cells * request.reference.squaredNorm() +
                               reference::least(a, c, sum, square).value;
                }
                const double error = std::abs(*answer.objective_value - expected) / (std::abs(expected) + 1e-3 * level);
                worst = std::max(worst, error);
                EXPECT_LT(error, 1e-7) << *answer.objective_value << " against " << expected;  // of the search
                ++compared;
                if (problem.kind == PatternKind::stuck) ++stuck;
            }
        }
    });
    std::printf("%d levels compared (%d of stuck patterns), worst %.1e\n", compared, stuck, worst);
    EXPECT_GT(compared, longer ? 2'000 : 100);
    EXPECT_GT(stuck, 20);
}

// Free vibrations: no closed form. What is called the best is not beaten from anywhere, and no bound is above any
// orbit.
TEST(OptimumSpectrum, ChainsClaimNoMoreThanIsTrue) {
    const bool longer = std::getenv("NSMA_LONG_TESTS") != nullptr;
    int compared = 0, global = 0, beaten = 0;
    nsma::OrbitSolver solver;
    for_each_pattern(2, longer ? 6 : 3, [&](const Subject& subject) {
        const auto& problem = subject.problem;
        if (problem.kind != PatternKind::free) return;
        const Pattern& pattern = problem.kernel.pattern;
        for (const double level : subject.levels) {
            const nsma::LevelPoints points(problem.set, level);
            for (const auto objective : {Objective::least_shock, Objective::nearest, Objective::least_force}) {
                nsma::OrbitRequest request{level, objective, {}, {}};
                if (objective == Objective::nearest) request.reference = target_window(subject, 0.7);
                const auto answer = solver.solve(subject.bar, problem, request);
                SCOPED_TRACE(testing::Message()
                             << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps << ") "
                             << nsma::name(objective) << " at " << level);
                ASSERT_EQ(answer.verdict, nsma::Verdict::admissible) << answer.reason;
                ASSERT_TRUE(answer.optimality);
                ++compared;
                if (objective == Objective::least_force) {
                    EXPECT_EQ(*answer.objective_value, 0.0);
                    EXPECT_TRUE(answer.optimality->global && answer.classification->forceless);
                    continue;
                }
                const literal::Program program(pattern, 1, objective, request.reference);
                std::vector<VectorXd> starts;
                for (int k = 0; k < 12; ++k) {
                    if (const auto start = points.start(k)) starts.push_back(problem.set.reduction.beta(*start));
                }
                const double found = program.least(level, {}, starts);
                EXPECT_LE(answer.optimality->lower_bound.value_or(found), found + 1e-6 * (std::abs(found) + level));
                if (answer.optimality->global) {
                    EXPECT_LE(*answer.objective_value, found + 2e-6 * (std::abs(found) + 1e-3 * level));
                    ++global;
                } else {
                    EXPECT_NE(answer.reason.find("not proved the best"), std::string::npos) << answer.reason;
                    if (found < *answer.objective_value * (1 - 1e-3)) {
                        ++beaten;
                        std::printf("(%d, %d, %d) %s at %g: %.10g found, %.10g answered\n", pattern.cells,
                                    pattern.free_steps, pattern.contact_steps,
                                    std::string(nsma::name(objective)).c_str(), level, found, *answer.objective_value);
                    }
                }
            }
        }
    });
    std::printf("%d levels of chains, %d of shock or distance proved the best, %d others beaten by more than 0.1 %%\n",
                compared, global, beaten);
    EXPECT_GT(compared, 50);
    EXPECT_EQ(beaten, 0);
}

// `sensitivity` speaks of the orbits that `orbit` and `sweep` give.
TEST(OptimumSpectrum, SensitivityHasTheAnswersOfTheSolver) {
    int compared = 0;
    nsma::OrbitSolver solver;
    for_each_pattern(2, 4, [&](const Subject& subject) {
        const auto& problem = subject.problem;
        const Pattern& pattern = problem.kernel.pattern;
        for (const auto objective :
             {Objective::least_shock, Objective::nearest, Objective::least_force, Objective::max_energy}) {
            if (objective == Objective::max_energy && subject.bar.gap_sign() == 0) continue;  // without end
            const bool extreme = objective == Objective::max_energy;
            const auto levels = extreme ? std::vector<double>{} : subject.levels;
            nsma::Scene scene;
            scene.bar = subject.bar;
            scene.mesh.cells = pattern.cells;
            scene.patterns = nsma::ListSelection{{{pattern.free_steps, pattern.contact_steps}}};
            scene.levels = levels;
            scene.objective = objective;
            scene.all_kinds = true;
            nsma::SensitivityRequest request;
            request.amounts.clear();
            const auto seen = nsma::sensitivity(scene, request, [] { return true; });
            // Each level of `nearest` stays near the one before, as in a sweep.
            VectorXd before;
            std::size_t i = subject.bar.gap_sign() != 0 ? 1 : 0;
            if (extreme) {
                const auto answer = solver.solve(subject.bar, problem, {{}, objective, {}, {}});
                ASSERT_TRUE(answer.orbit) << answer.reason;
                ASSERT_EQ(seen.optima.size(), 1U);
                EXPECT_EQ(seen.optima[0].orbit.beta, answer.orbit->beta);
                EXPECT_DOUBLE_EQ(seen.optima[0].value, *answer.objective_value);
                EXPECT_EQ(seen.optima[0].global, nsma::proved_best(answer));
                ++compared;
                continue;
            }
            for (const double level : subject.levels) {
                const auto answer = solver.solve(subject.bar, problem, {level, objective, before, {}});
                ASSERT_TRUE(answer.orbit);
                if (objective == Objective::nearest) before = nsma::reference_window(*answer.orbit);
                SCOPED_TRACE(testing::Message()
                             << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps << ") gap "
                             << subject.bar.gap_sign() << " " << nsma::name(objective) << " at " << level);
                ASSERT_LT(i, seen.optima.size());
                const auto& record = seen.optima[i++];
                EXPECT_EQ(record.level, level);
                EXPECT_EQ(record.orbit.beta, answer.orbit->beta);
                EXPECT_EQ(record.global, answer.optimality && answer.optimality->global);
                // The analysis may polish; where it says it is stationary it stays.
                EXPECT_NEAR(record.value, *answer.objective_value,
                            1e-6 * (std::abs(*answer.objective_value) + 1e-3 * level))
                    << record.refusal;
                EXPECT_GE(record.value, -1e-12);
                ++compared;
            }
            EXPECT_EQ(i, seen.optima.size());
        }
    });
    EXPECT_GT(compared, 300);
}

}  // namespace
