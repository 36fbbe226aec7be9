#include "nsma/search/orbit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "../support/bar_with_gap.hpp"
#include "set/level_points.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"

namespace {

using Eigen::VectorXd;
using nsma::Agreement;
using nsma::Bar;
using nsma::Objective;
using nsma::OrbitAnswer;
using nsma::OrbitRequest;
using nsma::OrbitSolver;
using nsma::OrbitSolverOptions;
using nsma::Pattern;
using nsma::pattern_problem;
using nsma::SolverChoice;
using nsma::Verdict;

/// Both solvers, what they agree about being tested.
OrbitSolverOptions usual() {
    OrbitSolverOptions options;
    options.solvers = SolverChoice::both;
    return options;
}

OrbitAnswer solve(const Pattern& pattern, double gap, const OrbitRequest& request,
                  const OrbitSolverOptions& options = usual()) {
    const Bar bar = bar_with_gap(gap);
    return OrbitSolver(options).solve(bar, pattern_problem(pattern, bar.gap_sign()), request);
}

double least_energy(const Pattern& pattern, int gap_sign) {
    return *pattern_problem(pattern, gap_sign).set.interval().least;
}

/// What every admissible answer must be, judged again from its orbit alone.
void expect_sound(const OrbitAnswer& answer) {
    ASSERT_EQ(answer.verdict, Verdict::admissible) << answer.reason;
    ASSERT_TRUE(answer.orbit);
    const auto judged = nsma::replay(*answer.orbit, answer.level, 1000);
    EXPECT_TRUE(judged.accepted) << judged.violations.worst();
    EXPECT_LE(judged.violations.worst(), 1e-9);  // the acceptance of the project
    EXPECT_LE(answer.replay->violations.worst(), 1e-9);
    if (answer.level) {
        EXPECT_NEAR(*answer.energy, *answer.level, 1e-12 * *answer.level);  // same
    }
    EXPECT_NEAR(nsma::energy_ratio(*answer.orbit), *answer.energy, 1e-13 * *answer.energy);
    EXPECT_GE(*answer.objective_value, 0.0);
    EXPECT_TRUE(answer.classification.has_value());
    EXPECT_FALSE(answer.method.empty());
}

TEST(OrbitSolver, BothSolversAgreeOnTheFirstMode) {
    const Pattern pattern{20, 48, 16};
    const auto answer = solve(pattern, 1, {.level = 1.5 * least_energy(pattern, 1), .reference = {}});
    expect_sound(answer);
    EXPECT_EQ(answer.agreement, Agreement::agree);
    ASSERT_TRUE(answer.objective_difference);
    EXPECT_LE(*answer.objective_difference, 1e-6);
    ASSERT_GE(answer.solvers.size(), 2U);
    EXPECT_EQ(answer.solvers[0].name, "ipopt");
    EXPECT_EQ(answer.solvers[1].name.substr(0, 5), "nlopt");
}

TEST(OrbitSolver, ElevenClassesAtOneAndAHalf) {
    const Pattern pattern{6, 23, 1};
    const auto answer = solve(pattern, 1, {.level = 1.5 * 12.0 / 11.0, .reference = {}});
    expect_sound(answer);
    EXPECT_EQ(answer.kernel_dimension, 11);
    EXPECT_EQ(answer.agreement, Agreement::agree);
}

TEST(OrbitSolver, LeastShockIsNotWorseThanRandomAdmissiblePoints) {
    for (const auto& pattern : {Pattern{20, 48, 16}, {6, 23, 1}, {6, 16, 4}}) {
        const auto problem = pattern_problem(pattern, 1);
        const double level = 1.5 * *problem.set.interval().least;
        const auto answer = solve(pattern, 1, {.level = level, .reference = {}});
        expect_sound(answer);
        const nsma::LevelPoints points(problem.set, level);
        double best = nsma::no_bound;
        for (int k = 0; k < 2000; ++k) {
            const VectorXd beta = problem.set.reduction.beta(*points.start(k));
            best = std::min(best, nsma::objective_of_waves(problem.kernel, Objective::least_shock, beta));
        }
        EXPECT_LE(*answer.objective_value, best * (1 + 1e-12));  // rounding of the same sum
    }
}

TEST(OrbitSolver, Verdicts) {
    EXPECT_EQ(solve({1, 1, 2}, 1, {}).verdict, Verdict::trivial);
    EXPECT_EQ(solve({6, 16, 4}, -1, {}).verdict, Verdict::inadmissible);
    for (const double level : {1e-9, 8.999}) {
        const auto below = solve({6, 16, 4}, 1, {.level = level, .reference = {}});  // [9, 36]
        EXPECT_EQ(below.verdict, Verdict::below);
        EXPECT_FALSE(below.reason.empty());
        EXPECT_FALSE(below.orbit);
        EXPECT_TRUE(below.solvers.empty());
    }
    EXPECT_EQ(solve({6, 16, 4}, 1, {.level = 36.001, .reference = {}}).verdict, Verdict::above);
    expect_sound(solve({6, 16, 4}, 1, {.level = 9.001, .reference = {}}));
    expect_sound(solve({6, 16, 4}, 1, {.level = 35.999, .reference = {}}));
}

TEST(OrbitSolver, EndsOfTheIntervalNeedNoSolver) {
    for (const auto& pattern : {Pattern{6, 16, 4}, {6, 23, 1}}) {
        const auto interval = pattern_problem(pattern, 1).set.interval();
        for (const double level : {*interval.least, *interval.greatest}) {
            const auto answer = solve(pattern, 1, {.level = level, .reference = {}});
            expect_sound(answer);
            EXPECT_TRUE(answer.solvers.empty());
            EXPECT_EQ(answer.agreement, Agreement::not_needed);
        }
    }
}

TEST(OrbitSolver, OneAmplitudeIsClosedForm) {
    // N = 6, (18, 3): T = 3.5 tau, mode 1, g = gcd(12, 21) = 3, q = 6, s = 0: m = 3. N = 5,
    // (14, 3): n_T = 17, g = 1, q = 14: m = 1 and E = 1/(17/5 - 3)^2 = 25/4.
    const Pattern pattern{5, 14, 3};
    ASSERT_EQ(nsma::kernel_dimension(pattern), 1);
    const double energy = 25.0 / 4.0;
    const auto answer = solve(pattern, 1, {});
    expect_sound(answer);
    EXPECT_NEAR(*answer.energy, energy, 1e-13 * energy);
    EXPECT_TRUE(answer.solvers.empty());
    EXPECT_EQ(answer.agreement, Agreement::not_needed);
    const auto same = solve(pattern, 1, {.level = *answer.energy, .reference = {}});
    expect_sound(same);
    EXPECT_TRUE(same.solvers.empty());
    EXPECT_EQ(solve(pattern, 1, {.level = 0.999 * energy, .reference = {}}).verdict, Verdict::below);
    EXPECT_EQ(solve(pattern, 1, {.level = 1.001 * energy, .reference = {}}).verdict, Verdict::above);
}

TEST(OrbitSolver, WithoutALevelTheLeastEnergy) {
    const auto answer = solve({6, 23, 1}, 1, {});
    expect_sound(answer);
    EXPECT_NEAR(*answer.energy, 12.0 / 11.0, 1e-12);
    EXPECT_FALSE(answer.level);
    EXPECT_TRUE(answer.solvers.empty());
}

TEST(OrbitSolver, EveryObjective) {
    const Pattern pattern{6, 16, 4};
    // Simplex sum gamma = 1, E = 36 |gamma|^2 in [9, 36].
    const auto least = solve(pattern, 1, {.level = std::nullopt, .objective = Objective::min_energy, .reference = {}});
    expect_sound(least);
    EXPECT_NEAR(*least.energy, 9, 1e-11);
    EXPECT_NEAR(*least.objective_value, 9, 1e-11);
    const auto most = solve(pattern, 1, {.level = std::nullopt, .objective = Objective::max_energy, .reference = {}});
    expect_sound(most);
    EXPECT_NEAR(*most.energy, 36, 1e-10);
    EXPECT_NEAR(*most.objective_value, 36, 1e-10);

    // least-force at 12 = 36/3: the peak gamma of a unit simplex with |gamma|^2 = 1/3. With k equal
    // largest entries a and one rest b >= 0 ... k = 3: 3a + b = 1, 3a^2 + b^2 = 1/3 gives a = 1/3,
    // b = 0; two or one large entries need a larger peak. Force = 2N gamma = 12/3.
    const auto force = solve(pattern, 1, {.level = 12.0, .objective = Objective::least_force, .reference = {}});
    expect_sound(force);
    EXPECT_NEAR(*force.objective_value, 4, 1e-6);
    EXPECT_NEAR(nsma::contact_force(*force.orbit).cwiseAbs().maxCoeff() / force.orbit->bar.force_unit(),
                *force.objective_value, 1e-12);

    // nearest: to an orbit of the same level it is that orbit, at distance zero.
    const auto smooth = solve(pattern, 1, {.level = 12.0, .reference = {}});
    expect_sound(smooth);
    OrbitRequest nearest{
        .level = 12.0, .objective = Objective::nearest, .reference = nsma::reference_window(*smooth.orbit)};
    const auto same = solve(pattern, 1, nearest);
    expect_sound(same);
    EXPECT_NEAR(*same.objective_value, 0, 1e-9);
    // From the least-energy point (centre of the simplex, gamma = 1/4) every point of the level
    // is at E-distance 12 - 9 (Pythagoras: the level's points and the centre lie in one plane).
    const auto from_least = solve(pattern, 1, {.level = 12.0, .objective = Objective::nearest, .reference = {}});
    expect_sound(from_least);
    EXPECT_NEAR(*from_least.objective_value, 3, 1e-10);
}

TEST(OrbitSolver, LeastForceBeatsRandomPoints) {
    const Pattern pattern{20, 48, 16};
    const auto problem = pattern_problem(pattern, 1);
    const double level = 1.5 * *problem.set.interval().least;
    const auto answer = solve(pattern, 1, {.level = level, .objective = Objective::least_force, .reference = {}});
    expect_sound(answer);
    const nsma::LevelPoints points(problem.set, level);
    for (int k = 0; k < 1000; ++k) {
        const VectorXd beta = problem.set.reduction.beta(*points.start(k));
        EXPECT_LE(*answer.objective_value,
                  nsma::objective_of_waves(problem.kernel, Objective::least_force, beta) * (1 + 1e-9));
    }
}

TEST(OrbitSolver, ClosedGap) {
    const Pattern pattern{8, 16, 8};  // mode 1 at T = 3 tau
    for (const double level : {1e-3, 1.0, 1e3}) {
        const auto answer = solve(pattern, 0, {.level = level, .reference = {}});
        expect_sound(answer);
        EXPECT_NEAR(nsma::energy(*answer.orbit), level, 1e-12 * level);  // joules
    }
    EXPECT_EQ(solve(pattern, 0, {}).verdict, Verdict::failed);  // no least-energy orbit
    for (const auto objective : {Objective::min_energy, Objective::max_energy}) {
        EXPECT_EQ(solve(pattern, 0, {.level = std::nullopt, .objective = objective, .reference = {}}).verdict,
                  Verdict::failed);
    }
    expect_sound(solve(pattern, 0, {.level = 1.0, .objective = Objective::nearest, .reference = {}}));
}

// One unit of displacement for every closed gap: the stretch that stores one joule.
TEST(OrbitSolver, ClosedGapOfABarThatIsNotOfUnits) {
    const Bar steel{0.5, 70e9, 2700.0, 7.85e-5, 0.0};
    const double unit = std::sqrt(2 * 0.5 / (70e9 * 7.85e-5));  // Y S u^2/(2 L) = 1 J
    const Pattern pattern{8, 16, 8};
    const auto problem = pattern_problem(pattern, 0);
    OrbitSolver solver;
    for (const auto objective : {Objective::least_shock, Objective::least_force}) {
        const auto answer = solver.solve(steel, problem, {.level = 0.3, .objective = objective, .reference = {}});
        expect_sound(answer);
        EXPECT_NEAR(nsma::energy(*answer.orbit), 0.3, 1e-12);
        const double step = 0.5 / std::sqrt(70e9 / 2700.0) / 8;
        EXPECT_LT((nsma::amplitudes(*answer.orbit) - answer.orbit->beta * (unit / step)).norm(),
                  1e-12 * nsma::amplitudes(*answer.orbit).norm());
        if (objective != Objective::least_force) continue;
        const double newton = 70e9 * 7.85e-5 * unit / 0.5;
        EXPECT_NEAR(nsma::contact_force(*answer.orbit).cwiseAbs().maxCoeff(), *answer.objective_value * newton,
                    1e-12 * newton);
    }
}

TEST(OrbitSolver, Prestressed) {
    // Mode 1 for d < 0: T from 2 tau to 3 tau. N = 10, n_T = 24: r = 8, p = 16, g = 4, m = 4,
    // E_min = 1/(2.4 - 3)^2.
    const Pattern pattern{10, 8, 16};
    const double least = 1 / (0.6 * 0.6);
    EXPECT_NEAR(least_energy(pattern, -1), least, 1e-12 * least);
    const auto answer = solve(pattern, -1, {.level = 1.5 * least, .reference = {}});
    expect_sound(answer);
    EXPECT_EQ(answer.gap_sign, -1);
}

TEST(OrbitSolver, UnitsChangeNothingButUnits) {
    const Bar steel{1.0, 210e9, 7850.0, 1e-4, 1e-4};
    const Pattern pattern{20, 48, 16};
    const auto problem = pattern_problem(pattern, 1);
    const OrbitRequest request{.level = 1.5 * *problem.set.interval().least, .reference = {}};
    OrbitSolver solver(usual());
    const auto unit = solver.solve(bar_with_gap(1), problem, request);
    const auto rod = solver.solve(steel, problem, request);
    expect_sound(unit);
    expect_sound(rod);
    EXPECT_NEAR(*unit.objective_value, *rod.objective_value, 1e-12 * *unit.objective_value);
    EXPECT_LT((unit.orbit->beta - rod.orbit->beta).norm(), 1e-12 * unit.orbit->beta.norm());
    const double joule = 210e9 * 1e-4 * 1e-8 / 2;  // Y S d^2 / (2 L)
    EXPECT_NEAR(nsma::energy(*rod.orbit), *request.level * joule, 1e-12 * *request.level * joule);
}

// A level asked for twice with `nearest`, and a closed gap's levels: the optimum is at distance 0, where only an
// absolute comparison of two objectives has a meaning.
TEST(OrbitSolver, BothSolversAgreeAtDistanceZero) {
    for (const auto& [pattern, gap] :
         {std::pair{Pattern{6, 16, 4}, 1.0}, {Pattern{8, 4, 4}, -1.0}, {Pattern{6, 10, 8}, 0.0}}) {
        const Bar bar = bar_with_gap(gap);
        const auto problem = pattern_problem(pattern, bar.gap_sign());
        ASSERT_EQ(problem.verdict, Verdict::admissible);
        const double level = gap == 0 ? 3.0 : 0.5 * (*problem.interval.least + *problem.interval.greatest);
        const auto first = solve(pattern, gap, {level, Objective::least_shock, {}, {}});
        ASSERT_TRUE(first.orbit);
        const auto answer = solve(pattern, gap, {level, Objective::nearest, nsma::reference_window(*first.orbit), {}});
        expect_sound(answer);
        EXPECT_NEAR(*answer.objective_value, 0.0, 1e-12 * level);  // rounding of amplitudes of that energy
        EXPECT_EQ(answer.agreement, Agreement::agree) << answer.reason;
        ASSERT_TRUE(answer.optimality);
        EXPECT_TRUE(answer.optimality->global);
        EXPECT_GE(answer.optimality->lower_bound, 0.0);
    }
}

TEST(OrbitSolver, OneSolverAlone) {
    const Pattern pattern{20, 48, 16};
    const OrbitRequest request{.level = 1.5 * least_energy(pattern, 1), .reference = {}};
    const auto both = solve(pattern, 1, request);
    for (const auto choice : {SolverChoice::ipopt, SolverChoice::nlopt}) {
        OrbitSolverOptions options = usual();
        options.solvers = choice;
        const auto answer = solve(pattern, 1, request, options);
        expect_sound(answer);
        EXPECT_EQ(answer.agreement, Agreement::single);
        EXPECT_FALSE(answer.objective_difference);
        const std::string name = choice == SolverChoice::ipopt ? "ipopt" : "nlopt";
        for (const auto& run : answer.solvers) EXPECT_EQ(run.name.substr(0, 5), name);
        EXPECT_NEAR(*answer.objective_value, *both.objective_value, 1e-6 * *both.objective_value);
    }
}

TEST(OrbitSolver, ASimplexNeedsNoSolver) {
    const Pattern pattern{20, 48, 16};
    for (const double factor : {1.01, 1.5, 3.0, 7.9}) {
        const OrbitRequest request{.level = factor * least_energy(pattern, 1), .reference = {}};
        const auto both = solve(pattern, 1, request);
        OrbitSolverOptions first_proof = usual();
        first_proof.solvers = SolverChoice::proof;
        const auto proof = solve(pattern, 1, request, first_proof);
        expect_sound(proof);
        // Not above the cross-checked answer by more than the agreement asked for.
        EXPECT_LE(*proof.objective_value, *both.objective_value * (1 + 1e-6));
        EXPECT_EQ(proof.method, "closed-form");
        EXPECT_TRUE(proof.solvers.empty());
        EXPECT_FALSE(both.solvers.empty());
        EXPECT_EQ(proof.agreement, Agreement::not_needed);
        EXPECT_TRUE(proof.optimality && proof.optimality->global);
    }
}

TEST(OrbitSolver, IpoptStartsFromAnOrbitAtALevelNearby) {
    const Pattern pattern{20, 48, 16};
    const double least = least_energy(pattern, 1);
    const auto near = solve(pattern, 1, {.level = 1.6 * least}, usual());
    const auto cold = solve(pattern, 1, {.level = 1.5 * least}, usual());
    const auto warm = solve(pattern, 1, {.level = 1.5 * least, .start = near.orbit->beta}, usual());
    expect_sound(warm);
    EXPECT_NEAR(*warm.objective_value, *cold.objective_value, 1e-6 * *cold.objective_value);  // the agreement asked for
    const auto first = [](const OrbitAnswer& answer, const char* name) {
        return *std::find_if(answer.solvers.begin(), answer.solvers.end(),
                             [&](const auto& run) { return run.name == name; });
    };
    EXPECT_EQ(first(cold, "ipopt").start, 0);
    EXPECT_EQ(first(warm, "ipopt").start, -1);
    EXPECT_LT(first(warm, "ipopt").iterations, first(cold, "ipopt").iterations);
    // NLopt, the other witness, knows nothing of it.
    EXPECT_EQ(first(warm, "nlopt-slsqp").start, first(cold, "nlopt-slsqp").start);
    EXPECT_EQ(first(warm, "nlopt-slsqp").objective, first(cold, "nlopt-slsqp").objective);
}

TEST(OrbitSolver, AUselessStartIsMadeGoodByThatOfTheLevel) {
    const Pattern pattern{20, 48, 16};
    const double least = least_energy(pattern, 1);
    OrbitSolverOptions options = usual();
    options.solvers = SolverChoice::ipopt;
    options.starts = 1;
    options.raw_violation = -1;  // nothing is good enough
    const auto near = solve(pattern, 1, {.level = 1.6 * least}, usual());
    const auto answer = solve(pattern, 1, {.level = 1.5 * least, .start = near.orbit->beta}, options);
    std::vector<int> starts;
    for (const auto& run : answer.solvers) starts.push_back(run.start);
    ASSERT_GE(starts.size(), 2U);
    EXPECT_EQ(std::count(starts.begin(), starts.end(), -1), 1);
    EXPECT_EQ(std::count(starts.begin(), starts.end(), 0), 1);
}

TEST(OrbitSolver, AStartOfAnotherPatternIsMisuse) {
    const Pattern pattern{20, 48, 16};
    const double level = 1.5 * least_energy(pattern, 1);
    EXPECT_THROW((void)solve(pattern, 1, {.level = level, .start = VectorXd::Ones(1)}), std::invalid_argument);
    EXPECT_THROW((void)solve(pattern, 1, {.level = level, .start = VectorXd::Constant(8, std::nan(""))}),
                 std::invalid_argument);
}

TEST(OrbitSolver, StarvedSolversStillGiveAnOrbitAndSaySo) {
    OrbitSolverOptions options = usual();
    options.solver.max_iterations = 1;
    options.solver.time_limit = 1e-9;
    options.raw_violation = -1;  // no raw answer is good enough
    const Pattern pattern{20, 48, 16};
    const auto answer = solve(pattern, 1, {.level = 1.5 * least_energy(pattern, 1), .reference = {}}, options);
    EXPECT_EQ(answer.agreement, Agreement::both_failed);
    expect_sound(answer);
    EXPECT_EQ(answer.method, "closed-form");
    EXPECT_EQ(answer.reason, "no solver came to the best orbit known; found by the closed-form");
    for (const auto& run : answer.solvers) EXPECT_FALSE(run.usable);
}

TEST(OrbitSolver, TwoRunsGiveTheSameBits) {
    for (const auto& pattern : {Pattern{20, 48, 16}, {6, 23, 1}}) {
        const OrbitRequest request{.level = 2.2 * least_energy(pattern, 1), .reference = {}};
        const auto a = solve(pattern, 1, request);
        OrbitSolver used(usual());
        const auto problem = pattern_problem(pattern, 1);
        (void)used.solve(bar_with_gap(1), problem, {.level = 1.7 * least_energy(pattern, 1), .reference = {}});
        const auto b = used.solve(bar_with_gap(1), problem, request);  // on an object with a past
        ASSERT_TRUE(a.orbit && b.orbit);
        EXPECT_EQ(a.orbit->beta, b.orbit->beta);
        EXPECT_EQ(a.method, b.method);
        EXPECT_EQ(a.solvers.size(), b.solvers.size());
    }
}

TEST(OrbitSolver, ManyLevelsOfManyPatternsAreSound) {
    OrbitSolver solver(usual());
    int solved = 0;
    for (const int gap_sign : {-1, 1}) {
        for (int period = 2; period <= 24; ++period) {
            for (int contact = 1; contact < period; ++contact) {
                const auto problem = pattern_problem({6, period - contact, contact}, gap_sign);
                if (problem.verdict != Verdict::admissible) continue;
                const auto interval = problem.set.interval();
                const double top = interval.greatest.value_or(20 * *interval.least);
                for (const double share : {0.0, 0.2, 0.8, 1.0}) {
                    const double level = *interval.least + share * (top - *interval.least);
                    const auto answer =
                        solver.solve(bar_with_gap(gap_sign), problem, {.level = level, .reference = {}});
                    SCOPED_TRACE(testing::Message() << "(" << period - contact << ", " << contact << ") gap "
                                                    << gap_sign << " level " << level);
                    expect_sound(answer);
                    ++solved;
                }
            }
        }
    }
    EXPECT_GT(solved, 200);
}

// Polishing came to a point that its active rows and the sphere determine alone, and crashed.
TEST(OrbitSolver, ActiveRowsMayDetermineTheOrbit) {
    const auto answer = solve({20, 46, 18}, 1, {.level = 100.0, .reference = {}}, usual());
    expect_sound(answer);
}

TEST(OrbitSolver, Misuse) {
    OrbitSolver solver;
    const auto problem = pattern_problem({6, 16, 4}, 1);
    EXPECT_THROW((void)solver.solve(bar_with_gap(-1), problem, {}), std::invalid_argument);
    EXPECT_THROW((void)solver.solve(bar_with_gap(0), problem, {}), std::invalid_argument);
    for (const double level : {0.0, -1.0, std::nan(""), nsma::no_bound}) {
        EXPECT_THROW((void)solver.solve(bar_with_gap(1), problem, {.level = level, .reference = {}}),
                     std::invalid_argument);
    }
    OrbitRequest wrong{.level = 12.0, .objective = Objective::nearest, .reference = VectorXd::Ones(5)};
    EXPECT_THROW((void)solver.solve(bar_with_gap(1), problem, wrong), std::invalid_argument);
    // A level at an end of the interval takes another way: the same word.
    wrong.level = *problem.set.interval().greatest;
    EXPECT_THROW((void)solver.solve(bar_with_gap(1), problem, wrong), std::invalid_argument);
    // An extreme of the energy has no level.
    EXPECT_THROW((void)solver.solve(bar_with_gap(1), problem,
                                    {.level = 12.0, .objective = Objective::max_energy, .reference = {}}),
                 std::invalid_argument);
    EXPECT_THROW((void)pattern_problem({0, 1, 1}, 1), std::invalid_argument);
    EXPECT_THROW((void)pattern_problem({6, 0, 4}, 1), std::invalid_argument);
    OrbitSolverOptions options;
    options.starts = 0;
    EXPECT_THROW(OrbitSolver{options}, std::invalid_argument);
}

TEST(OrbitSolver, LevelsAFewRoundingsInsideTheIntervalHaveAnOrbit) {
    for (const auto& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {20, 60, 10}}) {
        const auto problem = pattern_problem(pattern, 1);
        OrbitSolver solver(usual());
        for (const bool greatest : {false, true}) {
            const double end = greatest ? *problem.interval.greatest : *problem.interval.least;
            double level = end;
            for (int step = 0; step < 40; ++step) {
                level = std::nextafter(level, greatest ? 0.0 : 2 * end);
                const auto answer = solver.solve(bar_with_gap(1), problem, {.level = level, .reference = {}});
                ASSERT_EQ(answer.verdict, Verdict::admissible) << answer.reason << " at " << level - end;
                ASSERT_TRUE(answer.orbit && answer.replay);
                EXPECT_NEAR(*answer.energy, level, 1e-12 * level);  // the acceptance of the project
            }
        }
    }
}

}  // namespace
