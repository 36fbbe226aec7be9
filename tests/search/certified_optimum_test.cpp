// Certificates of optima against a search over every face, and against forgeries.
#include "nsma/search/certified_optimum.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simplex_reference.hpp"
#include "nsma/search/orbit_solver.hpp"

namespace {

using nsma::Objective;
using nsma::Optimum;
using nsma::Pattern;
using nsma::PatternProblem;
using nsma::Rational;
using nsma::to_double;

/// 2N sum_n (b_{n+1} - b_n)^2 of the waves themselves, as a matrix over |beta|.
Eigen::MatrixXd shock_matrix(const PatternProblem& problem) {
    const int m = problem.kernel.dimension();
    const auto shock = [&](const Eigen::VectorXd& beta) {
        const Eigen::VectorXd b = problem.kernel.waves(beta);
        double sum = 0;
        for (Eigen::Index n = 0; n < b.size(); ++n) sum += std::pow(b[(n + 1) % b.size()] - b[n], 2);
        return 2.0 * problem.kernel.pattern.cells * sum;
    };
    Eigen::MatrixXd a(m, m);
    for (int i = 0; i < m; ++i) {
        for (int j = 0; j < m; ++j) {
            const Eigen::VectorXd e = Eigen::VectorXd::Unit(m, i);
            const Eigen::VectorXd f = Eigen::VectorXd::Unit(m, j);
            a(i, j) = 0.25 * (shock(e + f) - shock(e - f));
        }
    }
    return a;
}

/// An orbit to stay near, which need not be admissible: beta with entries of all sizes and signs.
Eigen::VectorXd target(const PatternProblem& problem, double energy) {
    const double size = std::sqrt(energy / problem.set.reduction.energy_factor);
    return Eigen::VectorXd::NullaryExpr(problem.kernel.dimension(), [&](Eigen::Index j) {
        return size * std::sin(17 * energy + 2.3 * static_cast<double>(j)) * std::cos(5 * energy);
    });
}

/// The best orbit at an energy and its proof.
nsma::OptimumProof certify(const PatternProblem& problem, Objective objective, double energy) {
    nsma::OrbitRequest request;
    request.objective = objective;
    request.level = energy;
    const auto& kernel = problem.kernel;
    if (objective == Objective::nearest) {
        request.reference.resize(2 * kernel.pattern.cells);
        for (int n = 0; n < request.reference.size(); ++n)
            request.reference[n] = kernel.wave(target(problem, energy), n);
    }
    const double gap = problem.set.reduction.gap_sign;
    return nsma::certified_optimum(problem, nsma::OrbitSolver().solve({.gap = gap}, problem, request));
}

/// The least value at an energy, of `nearest` the distance from `near`, by looking at every face.
double truth(const PatternProblem& problem, Objective objective, double energy, const Eigen::VectorXd& near) {
    const auto& set = problem.set;
    const double q = energy / set.reduction.energy_factor;
    const double s = set.reduction.gap_sign == 0 ? 0.0 : 1.0 / std::abs(set.reduction.contact_row[0]);
    const int m = problem.kernel.dimension();
    if (objective == Objective::least_force)
        return 2.0 * problem.kernel.pattern.cells * (s == 0 ? std::sqrt(q / m) : reference::least_peak(m, s, q));
    if (objective == Objective::least_shock)
        return reference::least(shock_matrix(problem), Eigen::VectorXd::Zero(m), s, q).value;
    const Eigen::VectorXd t = set.reduction.flip * near;
    const double product = reference::least(Eigen::MatrixXd::Zero(m, m), -0.5 * t, s, q).value;
    return set.reduction.energy_factor * (q + t.squaredNorm() + 2 * product);
}

/// What its values are compared in.
double scale_of(Objective objective, double value, double energy) {
    return objective == Objective::nearest ? energy : value;
}

std::vector<double> levels_of(const PatternProblem& problem) {
    if (problem.set.reduction.gap_sign == 0) return {0.3, 7.0};
    const double least = *problem.interval.least;
    const double greatest = *problem.interval.greatest;
    std::vector<double> levels;
    // Of 5 and 6 columns the second to fourth are such that a window of one column less than the best is still
    // possible.
    for (const double share : {0.02, 0.115, 0.18, 0.21, 0.3, 0.55, 0.85, 0.98})
        levels.push_back(least + share * (greatest - least));
    return levels;
}

template <class Visit>
void for_each_program(int largest, Visit visit) {
    std::vector<Pattern> patterns{{15, 36, 12}};  // six columns; small meshes have four at most
    for (int cells = 2; cells <= largest; ++cells) {
        for (int period = 2; period <= 4 * cells; ++period) {
            for (int free = 1; free < period; ++free) patterns.push_back({cells, free, period - free});
        }
    }
    for (const Pattern& pattern : patterns) {
        if (const int m = nsma::kernel_dimension(pattern); m < 2 || m > 6) continue;
        for (const int gap_sign : {-1, 0, 1}) {
            const PatternProblem problem = nsma::pattern_problem(pattern, gap_sign);
            const bool stuck = problem.kind == nsma::PatternKind::stuck && pattern.cells <= 3;
            if (problem.kind != nsma::PatternKind::contact && !stuck) continue;
            for (const Objective objective : {Objective::least_shock, Objective::least_force, Objective::nearest}) {
                for (const double level : levels_of(problem)) {
                    SCOPED_TRACE(testing::Message()
                                 << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps
                                 << ") gap " << gap_sign << ' ' << name(objective) << " at " << level);
                    visit(problem, objective, level);
                }
            }
        }
    }
}

TEST(CertifiedOptimum, IsTheBestOfEveryFace) {
    int programs = 0;
    for_each_program(10, [&](const PatternProblem& problem, Objective objective, double level) {
        const auto proof = certify(problem, objective, level);
        ASSERT_TRUE(proof.certificate) << proof.unproved;
        EXPECT_EQ(nsma::check(*proof.certificate).reason, "");
        EXPECT_LT(proof.gap, 1e-6);
        const Optimum& optimum = *proof.certificate->optimum;
        const double best = truth(problem, objective, level, target(problem, level));
        // The reference finds its points to 1e-9; the orbit's energy errs by 1e-9, its value by a few times that.
        const double scale = scale_of(objective, best, level);
        EXPECT_LE(to_double(optimum.bound), best + 1e-9 * scale);
        EXPECT_GE(to_double(optimum.bound), best - 1e-6 * scale);
        EXPECT_NEAR(to_double(optimum.value), best, 1e-6 * scale);
        EXPECT_LT(to_double(optimum.energy_error), 1e-8);
        ++programs;
    });
    EXPECT_GT(programs, 1000) << programs;
}

TEST(CertifiedOptimum, OfManyColumnsHasTheValueOfTheClosedForm) {
    for (const int m : {10, 16, 40, 90, 600}) {
        for (const double level : {26.0, 32.5, 70.0, 300.0, 1.2 * m}) {
            const Pattern pattern{5 * m / 2, 6 * m, 2 * m};
            const PatternProblem problem = nsma::pattern_problem(pattern, 1);
            if (outside(problem.interval, level)) continue;
            for (const Objective objective : {Objective::least_shock, Objective::least_force}) {
                SCOPED_TRACE(testing::Message() << m << ' ' << name(objective) << " at " << level);
                const auto proof = certify(problem, objective, level);
                ASSERT_TRUE(proof.certificate) << proof.unproved;
                nsma::OrbitRequest request;
                request.objective = objective;
                request.level = level;
                const auto answer = nsma::OrbitSolver().solve({}, problem, request);
                EXPECT_NEAR(to_double(proof.certificate->optimum->bound) / *answer.objective_value, 1.0, 1e-6);
            }
        }
    }
}

// No change of one number makes more than the truth of it.
TEST(CertifiedOptimum, NoForgeryPasses) {
    long rejected = 0, harmless = 0;
    for_each_program(4, [&](const PatternProblem& problem, Objective objective, double level) {
        const auto proof = certify(problem, objective, level);
        ASSERT_TRUE(proof.certificate);
        const auto attack = [&](auto change) {
            auto forged = *proof.certificate;
            change(*forged.optimum);
            if (!nsma::check(forged).valid) {
                ++rejected;
                return;
            }
            ++harmless;
            const double energy = to_double(forged.optimum->energy);
            if (outside(problem.interval, energy)) return;  // of no orbit everything is true
            constexpr Objective objectives[] = {Objective::least_shock, Objective::least_force, Objective::nearest};
            const Objective said = objectives[static_cast<std::size_t>(forged.optimum->objective)];
            Eigen::VectorXd near = Eigen::VectorXd::Zero(problem.kernel.dimension());
            for (const auto& [column, value] : forged.optimum->reference) near[column] = to_double(value);
            const double best = truth(problem, said, energy, near);
            EXPECT_LE(to_double(forged.optimum->bound), best + 1e-9 * scale_of(said, best, energy));
        };
        for (const Rational& factor : {Rational(1'000'001, 1'000'000), Rational(999'999, 1'000'000), Rational(2),
                                       Rational(1, 2), Rational(-1), Rational(0)}) {
            for (Rational Optimum::*member : {&Optimum::energy, &Optimum::bound, &Optimum::value,
                                              &Optimum::energy_error, &Optimum::multiplier, &Optimum::level})
                attack([&](Optimum& optimum) { optimum.*member *= factor; });
            // A bound that is moved with the multiplier or the window.
            attack([&](Optimum& optimum) { optimum.bound *= factor, optimum.multiplier *= factor; });
            attack([&](Optimum& optimum) { optimum.bound *= factor, ++optimum.window; });
            attack([&](Optimum& optimum) { optimum.bound *= factor, --optimum.window; });
        }
        if (!proof.certificate->optimum->reference.empty()) {
            attack([](Optimum& optimum) { optimum.reference.front().second *= -1; });
            attack([](Optimum& optimum) { optimum.reference.pop_back(); });
            attack([](Optimum& optimum) { optimum.level -= 1, optimum.multiplier += 1; });
            attack([](Optimum& optimum) { optimum.level += optimum.multiplier; });
            attack([](Optimum& optimum) { optimum.reference.front().first = 7; });
        }
        for (const int window : {-1, 0, 1, 2, 3, 4, 5, 6, 7, 1 << 30})
            attack([&](Optimum& optimum) { optimum.window = window; });
        attack([](Optimum& optimum) { optimum.orbit.clear(); });
        attack([](Optimum& optimum) { optimum.orbit.front().second *= 2; });
        attack([](Optimum& optimum) { optimum.orbit.front().first = 7; });
        for (const auto other : {Optimum::Of::least_shock, Optimum::Of::least_force, Optimum::Of::nearest})
            attack([&](Optimum& optimum) { optimum.objective = other; });
    });
    EXPECT_GT(rejected, harmless);
    EXPECT_GT(harmless, 100);
}

// Any window with any multiplier: what the checker takes for a bound is one. Wrong windows have bounds above the truth.
TEST(CertifiedOptimum, WhateverWindowAndMultiplierProveIsTrue) {
    long proved = 0;
    for_each_program(8, [&](const PatternProblem& problem, Objective objective, double level) {
        if (objective != Objective::least_shock) return;
        const auto proof = certify(problem, objective, level);
        ASSERT_TRUE(proof.certificate);
        const double best = truth(problem, objective, level, target(problem, level));
        auto forged = *proof.certificate;
        for (int window = 1; window <= problem.kernel.dimension(); ++window) {
            const bool close = window >= 3 && problem.kernel.dimension() >= 5;
            for (int step = -20; step < (close ? 600 : 60); ++step) {
                forged.optimum->window = window;
                forged.optimum->multiplier = close ? Rational(2 * step - 600 + 1, 401) : Rational(3 * step + 1, 97);
                const auto facts = nsma::optimum_facts(forged);
                if (!facts.reason.empty()) continue;
                ++proved;
                ASSERT_LE(to_double(facts.bound), best * (1 + 1e-9)) << window << ' ' << step;
            }
        }
    });
    EXPECT_GT(proved, 1000);
}

// At the least energy one orbit is left; an energy next to it leaves next to nothing, and the multipliers have no end.
TEST(CertifiedOptimum, AtTheLeastEnergyIsTheOneOrbit) {
    for (const Pattern& pattern : {Pattern{6, 16, 4}, Pattern{8, 24, 8}, Pattern{12, 60, 10}, Pattern{15, 36, 12}}) {
        for (const int gap_sign : {-1, 1}) {
            const PatternProblem problem = nsma::pattern_problem(pattern, gap_sign);
            if (problem.kind != nsma::PatternKind::contact) continue;
            for (const Objective objective : {Objective::least_shock, Objective::least_force, Objective::nearest}) {
                for (const double above : {0.0, 1e-15, 1e-14, 1e-12, 1e-9}) {
                    const double level = *problem.interval.least * (1 + above);
                    const auto proof = certify(problem, objective, level);
                    if (nsma::decimal(level) < *problem.proof.certificate.energy_least) continue;  // by rounding
                    ASSERT_TRUE(proof.certificate) << proof.unproved;
                    EXPECT_LT(proof.gap, 1e-6) << pattern.free_steps << ' ' << name(objective) << ' ' << above;
                }
            }
        }
    }
}

TEST(CertifiedOptimum, SaysWhatItCannotProve) {
    const PatternProblem contact = nsma::pattern_problem({6, 16, 4}, 1);
    EXPECT_EQ(certify(contact, Objective::least_shock, 100).unproved, "optimum: expected an orbit, got none");
    const PatternProblem free = nsma::pattern_problem({6, 23, 1}, 1);
    EXPECT_EQ(certify(free, Objective::least_force, 12).unproved, "optimum: expected a motion with contact");
}

}  // namespace
