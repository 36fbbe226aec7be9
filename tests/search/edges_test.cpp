// Where verdicts could go wrong: ends of the interval, vanishing gaps, extreme units, small meshes.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "../check/literal.hpp"
#include "../proof/truth.hpp"

#include "../support/bar_with_gap.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace {

using nsma::Bar;
using nsma::exact;
using nsma::OrbitAnswer;
using nsma::OrbitSolver;
using nsma::OrbitSolverOptions;
using nsma::Pattern;
using nsma::pattern_problem;
using nsma::PatternProblem;
using nsma::Rational;
using nsma::Verdict;

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

/// Verdicts are the subject here, not the optimum: one start, no bound.
OrbitSolverOptions quick() {
    OrbitSolverOptions options;
    options.solvers = nsma::SolverChoice::nlopt;
    options.starts = 1;
    return options;
}

void expect_on_level(const OrbitAnswer& answer) {
    ASSERT_EQ(answer.verdict, Verdict::admissible) << answer.reason;
    EXPECT_TRUE(answer.verdict_proved);
    ASSERT_TRUE(answer.orbit && answer.replay && answer.energy);
    EXPECT_TRUE(answer.replay->accepted);
    EXPECT_LE(answer.replay->violations.worst(), 1e-9);  // the acceptance of the project
    const auto judged = nsma::replay(*answer.orbit, answer.level, 3);
    EXPECT_LE(judged.violations.worst(), 1e-9);
    EXPECT_NEAR(*answer.energy, *answer.level, 1e-12 * *answer.level);  // asked of every answer
    EXPECT_NEAR(nsma::energy_ratio(*answer.orbit), *answer.level, 1e-12 * *answer.level);
}

void expect_outside(const OrbitAnswer& answer, Verdict verdict) {
    EXPECT_EQ(answer.verdict, verdict);
    EXPECT_TRUE(answer.verdict_proved);
    EXPECT_FALSE(answer.orbit);
    EXPECT_TRUE(answer.solvers.empty());
}

class Ends : public testing::TestWithParam<std::pair<Pattern, int>> {};

TEST_P(Ends, LevelsBesideBothEndsOfTheInterval) {
    const auto& [pattern, gap_sign] = GetParam();
    const Bar bar = bar_with_gap(gap_sign);
    const auto problem = pattern_problem(pattern, gap_sign);
    ASSERT_EQ(problem.verdict, Verdict::admissible);
    const auto& certificate = problem.proof.certificate;
    ASSERT_TRUE(certificate.energy_least && problem.proof.exact_greatest());
    OrbitSolver solver(quick());
    const auto at = [&](double level) { return solver.solve(bar, problem, {.level = level, .reference = {}}); };
    const bool bounded = certificate.ray.empty();
    const bool point = bounded && *certificate.energy_least == *certificate.energy_attained;
    for (int k = 1; k <= 12; ++k) {
        SCOPED_TRACE("10^-" + std::to_string(k));
        const double step = std::pow(10.0, -k);
        const double low = nsma::to_double(*certificate.energy_least);
        expect_outside(at(low * (1 - step)), Verdict::below);
        if (point) {
            expect_outside(at(low * (1 + step)), Verdict::above);
            continue;
        }
        if (!bounded) {
            expect_on_level(at(low * (1 + step)));
            expect_on_level(at(low / step));
            continue;
        }
        const double high = nsma::to_double(*certificate.energy_attained);
        expect_outside(at(high * (1 + step)), Verdict::above);
        // A long step may leave a short interval on the other side.
        const double inside = low * (1 + step);
        if (exact(inside) <= *certificate.energy_attained) {
            expect_on_level(at(inside));
        } else {
            expect_outside(at(inside), Verdict::above);
        }
        const double below_top = high * (1 - step);
        if (exact(below_top) >= *certificate.energy_least) {
            expect_on_level(at(below_top));
        } else {
            expect_outside(at(below_top), Verdict::below);
        }
    }
    // At the ends themselves, as exact as a double can say it.
    expect_on_level(at(nsma::to_double(*certificate.energy_least)));
    if (bounded) expect_on_level(at(nsma::to_double(*certificate.energy_attained)));
}

INSTANTIATE_TEST_SUITE_P(Patterns, Ends,
                         testing::Values(std::pair{Pattern{6, 16, 4}, 1}, std::pair{Pattern{6, 23, 1}, 1},
                                         std::pair{Pattern{20, 48, 16}, 1}, std::pair{Pattern{5, 14, 3}, 1},
                                         std::pair{Pattern{10, 8, 16}, -1}, std::pair{Pattern{12, 36, 6}, 1},
                                         std::pair{Pattern{1, 1, 1}, -1}));

TEST(Edges, LevelsBesideTheEndsOfPatternsWithFreeVariables) {
    // Free variables: live classes that no contact step bounds.
    int tried = 0;
    OrbitSolver solver(quick());
    for (int cells = 3; cells <= 8 && tried < (sanitized ? 4 : 12); ++cells) {
        for (const Pattern& pattern : truth::patterns(cells)) {
            for (const int gap_sign : {-1, 1}) {
                if (tried >= (sanitized ? 4 : 12)) break;
                const auto reduction = nsma::reduce(nsma::conditions(nsma::exact_kernel(pattern), gap_sign));
                if (reduction.variables() == 0 || reduction.bounded) continue;
                const auto problem = pattern_problem(pattern, gap_sign);
                if (problem.verdict != Verdict::admissible) continue;
                ++tried;
                SCOPED_TRACE(testing::Message() << "(" << cells << ", " << pattern.free_steps << ", "
                                                << pattern.contact_steps << ") gap " << gap_sign);
                const Bar bar = bar_with_gap(gap_sign);
                const auto at = [&](double level) {
                    return solver.solve(bar, problem, {.level = level, .reference = {}});
                };
                const auto& interval = problem.interval;
                ASSERT_TRUE(problem.proof.exact_greatest());
                for (const int k : {1, 6, 12}) {
                    const double step = std::pow(10.0, -k);
                    expect_outside(at(*interval.least * (1 - step)), Verdict::below);
                    if (interval.unbounded) {
                        expect_on_level(at(*interval.least * (1 + step)));
                        continue;
                    }
                    expect_outside(at(*interval.greatest * (1 + step)), Verdict::above);
                    if (*interval.greatest > *interval.least * 1.2) {
                        expect_on_level(at(*interval.least * (1 + step)));
                        expect_on_level(at(*interval.greatest * (1 - step)));
                    }
                }
            }
        }
    }
    EXPECT_GT(tried, 0);
}

TEST(Edges, AVanishingGapDecidesByItsSign) {
    OrbitSolver solver(quick());
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {6, 4, 10}, {6, 12, 6}, {5, 14, 3}, {1, 1, 2}}) {
        for (const int sign : {-1, 1}) {
            SCOPED_TRACE(testing::Message() << pattern.free_steps << ", " << pattern.contact_steps << " sign " << sign);
            const auto problem = pattern_problem(pattern, sign);
            const double level = problem.interval.least.value_or(2.0);
            const auto known = solver.solve(bar_with_gap(sign), problem, {.level = 1.1 * level, .reference = {}});
            for (const double size : {1e-9, 1e-12, nsma::least_gap}) {
                const Bar bar = bar_with_gap(sign * size);
                ASSERT_EQ(bar.gap_sign(), sign);
                for (const double factor : {0.999, 1.0}) {
                    const auto unit =
                        solver.solve(bar_with_gap(sign), problem, {.level = factor * level, .reference = {}});
                    const auto tiny = solver.solve(bar, problem, {.level = factor * level, .reference = {}});
                    EXPECT_EQ(tiny.verdict, unit.verdict);
                    EXPECT_EQ(tiny.verdict_proved, unit.verdict_proved);
                }
                const auto tiny = solver.solve(bar, problem, {.level = 1.1 * level, .reference = {}});
                EXPECT_EQ(tiny.verdict, known.verdict);
                EXPECT_EQ(tiny.orbit.has_value(), known.orbit.has_value());
                if (tiny.verdict == Verdict::admissible) expect_on_level(tiny);
            }
        }
    }
    // Beyond the range of doubles the energy unit is zero: refused, not judged.
    EXPECT_THROW(nsma::validate(bar_with_gap(1e-300)), std::invalid_argument);
    EXPECT_THROW(nsma::validate(bar_with_gap(-1e-300)), std::invalid_argument);
    EXPECT_EQ(bar_with_gap(-0.0).gap_sign(), 0);
}

TEST(Edges, UnitsFromMicrometresToKilometresChangeNothing) {
    OrbitSolver solver(quick());
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {5, 14, 3}}) {
        const auto problem = pattern_problem(pattern, 1);
        for (const double factor : {0.9, 1.0, 1.3, 1e3}) {
            const double level = factor * *problem.interval.least;
            const auto unit = solver.solve(bar_with_gap(1), problem, {.level = level, .reference = {}});
            for (const double length : {1e-6, 1e-3, 1.0, 1e3}) {
                for (const double gap_ratio : {1e-6, 0.1}) {
                    // Steel, with a section that follows the length.
                    const Bar bar{length, 210e9, 7850, 1e-4 * length * length, gap_ratio * length};
                    const auto answer = solver.solve(bar, problem, {.level = level, .reference = {}});
                    SCOPED_TRACE(testing::Message() << length << " m, gap " << bar.gap << " m, level " << level);
                    ASSERT_EQ(answer.verdict, unit.verdict);
                    EXPECT_EQ(answer.verdict_proved, unit.verdict_proved);
                    if (!unit.orbit) continue;
                    EXPECT_EQ(answer.orbit->beta, unit.orbit->beta);  // the program never sees the units
                    EXPECT_EQ(*answer.objective_value, *unit.objective_value);
                    expect_on_level(answer);
                }
            }
        }
    }
}

TEST(Edges, TheSmallestMeshes) {
    // N = 1, 2, 3, every pattern up to a period of 6N, all three signs, levels about both ends.
    OrbitSolver solver(quick());
    int admissible = 0;
    int trivial = 0;
    for (int cells = 1; cells <= (sanitized ? 2 : 3); ++cells) {
        for (int period = 2; period <= 6 * cells; ++period) {
            for (int contact = 1; contact < period; ++contact) {
                const Pattern pattern{cells, period - contact, contact};
                for (const int gap_sign : {-1, 0, 1}) {
                    SCOPED_TRACE(testing::Message() << "(" << cells << ", " << period - contact << ", " << contact
                                                    << ") gap " << gap_sign);
                    const auto problem = pattern_problem(pattern, gap_sign);
                    EXPECT_TRUE(problem.proof.verdict_proved) << problem.proof.unproved;
                    ASSERT_NE(problem.verdict, Verdict::failed);
                    const Bar bar = bar_with_gap(gap_sign);
                    const auto at = [&](double level) {
                        return solver.solve(bar, problem, {.level = level, .reference = {}});
                    };
                    if (problem.verdict != Verdict::admissible) {
                        EXPECT_EQ(at(1.0).verdict, problem.verdict);
                        EXPECT_TRUE(at(1.0).verdict_proved);
                        trivial += problem.verdict == Verdict::trivial ? 1 : 0;
                        continue;
                    }
                    ++admissible;
                    if (gap_sign == 0) {
                        for (const double level : {1e-9, 1.0, 1e9}) expect_on_level(at(level));
                        continue;
                    }
                    const auto& interval = problem.interval;
                    expect_outside(at(0.99 * *interval.least), Verdict::below);
                    expect_on_level(at(*interval.least));
                    if (interval.unbounded) {
                        expect_on_level(at(100 * *interval.least));
                        continue;
                    }
                    expect_on_level(at(0.5 * (*interval.least + *interval.greatest)));
                    expect_on_level(at(*interval.greatest));
                    expect_outside(at(1.01 * *interval.greatest), Verdict::above);
                }
            }
        }
    }
    EXPECT_GT(admissible, 20);
    EXPECT_GT(trivial, 5);
}

TEST(Edges, OneFreeStepOneContactStepAndShortPeriods) {
    OrbitSolver solver(quick());
    int admissible = 0;
    const int cells = 6;
    std::vector<Pattern> patterns;
    for (int other = 1; other <= 5 * cells; other += sanitized ? 3 : 1) {
        patterns.push_back({cells, 1, other});  // r = 1
        patterns.push_back({cells, other, 1});  // p = 1
    }
    for (int period = 2; period < 2 * cells; ++period) {  // n_T < 2N
        for (int contact = 1; contact < period; ++contact) patterns.push_back({cells, period - contact, contact});
    }
    for (const Pattern& pattern : patterns) {
        for (const int gap_sign : {-1, 1}) {
            SCOPED_TRACE(testing::Message()
                         << "(" << pattern.free_steps << ", " << pattern.contact_steps << ") gap " << gap_sign);
            const auto problem = pattern_problem(pattern, gap_sign);
            EXPECT_TRUE(problem.proof.verdict_proved) << problem.proof.unproved;
            ASSERT_NE(problem.verdict, Verdict::failed) << problem.set.reason;
            const auto literal = literal::problem(pattern, gap_sign);
            EXPECT_EQ(problem.verdict == Verdict::trivial, literal.dimension == 0);
            if (problem.verdict != Verdict::admissible) continue;
            ++admissible;
            const auto& interval = problem.interval;
            const Bar bar = bar_with_gap(gap_sign);
            expect_on_level(solver.solve(bar, problem, {.level = *interval.least, .reference = {}}));
            if (interval.greatest)
                expect_on_level(solver.solve(bar, problem, {.level = *interval.greatest, .reference = {}}));
            expect_outside(solver.solve(bar, problem, {.level = 0.5 * *interval.least, .reference = {}}),
                           Verdict::below);
        }
    }
    EXPECT_GT(admissible, 10);
}

TEST(Edges, PatternsWhoseClassesAreAllDead) {
    // One class (g = 1) and an odd number of free steps: b = -b, only rest is left.
    OrbitSolver solver(quick());
    for (const Pattern& pattern : {Pattern{1, 1, 2}, {5, 3, 4}, {7, 1, 2}, {24, 5, 6}}) {
        ASSERT_EQ(pattern.class_count(), 1);
        ASSERT_EQ(literal::problem(pattern, 1).dimension, 0);
        for (const int gap_sign : {-1, 0, 1}) {
            const auto problem = pattern_problem(pattern, gap_sign);
            EXPECT_EQ(problem.verdict, Verdict::trivial);
            EXPECT_TRUE(problem.proof.verdict_proved);
            EXPECT_TRUE(nsma::check(problem.proof.certificate).valid);
            for (const double level : {1e-12, 1.0, 1e12}) {
                expect_outside(solver.solve(bar_with_gap(gap_sign), problem, {.level = level, .reference = {}}),
                               Verdict::trivial);
            }
        }
    }
}

}  // namespace
