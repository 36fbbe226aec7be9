#include "nsma/price/shadow_prices.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "time_reversed.hpp"

#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"
#include "price/relaxed_solver.hpp"
#include "price/tied_optima.hpp"

// Every derivative against differences of programs solved again from the shifted right-hand
// sides. A step is accepted when the programs solved at it and at its parts hold the same rows:
// between them lies no change of the active set. Otherwise it is divided by eight.

namespace {

using nsma::Objective;
using nsma::OptimumSensitivity;
using nsma::RelaxedSet;
using nsma::Shift;
using nsma::Slope;

#if defined(__SANITIZE_ADDRESS__)
constexpr int cells_few = 5;
#else
constexpr int cells_few = 8;
#endif

Shift times(const Shift& direction, double t) {
    Shift result = direction;
    result.gap *= t;
    result.level *= t;
    result.contact *= t;
    result.band *= t;
    result.rows *= t;
    return result;
}

// Contact motions, with their parametric sets.
struct Case {
    nsma::PatternProblem problem;
    RelaxedSet set;
};

std::vector<Case> cases(int cells, int gap_sign) {
    std::vector<Case> result;
    nsma::PatternOptions options;
    options.prove = false;
    for (const auto& pattern : nsma::patterns_in(cells, {2, 4 * cells, 1, nsma::max_period_steps})) {
        auto problem = nsma::pattern_problem(pattern, gap_sign, options);
        if (problem.kind != nsma::PatternKind::contact) continue;
        RelaxedSet set = nsma::relaxed_set(problem.kernel, gap_sign);
        result.push_back({std::move(problem), std::move(set)});
    }
    return result;
}

nsma::OrbitSolverOptions quick() {
    nsma::OrbitSolverOptions options;
    options.solvers = nsma::SolverChoice::nlopt;
    options.starts = 4;
    return options;
}

// One optimum whose right-hand sides are shifted.
struct Subject {
    const RelaxedSet& set;
    Objective objective;
    std::optional<double> level;
    const OptimumSensitivity& optimum;

    [[nodiscard]] std::string words() const {
        const auto& pattern = set.kernel.pattern;
        return "(" + std::to_string(pattern.cells) + ", " + std::to_string(pattern.free_steps) + ", " +
               std::to_string(pattern.contact_steps) + ") " + std::string(nsma::name(objective)) + " at " +
               std::to_string(level.value_or(0));
    }
};

struct Resolved {
    double value;
    Eigen::VectorXd beta;
    std::vector<std::vector<int>> held;  ///< rows at equality: of beta, of its ties, of all backwards
};

std::vector<int> held_rows(const RelaxedSet& set, const Eigen::VectorXd& beta, const Shift& shift) {
    std::vector<int> held;
    const Eigen::VectorXd slack = set.limits(shift) - set.rows * beta;
    for (Eigen::Index i = 0; i < slack.size(); ++i) {
        // Programs solved again hold their rows to rounding, over entries of up to 2 N beta.
        if (slack[i] <= 1e-11 * (1 + beta.norm()) * (1 + set.rows.row(i).norm())) held.push_back(static_cast<int>(i));
    }
    return held;
}

// The program solved again from shifted right-hand sides, near the known optimum.
std::optional<Resolved> resolve(const Subject& subject, const Shift& shift) {
    const auto& [set, objective, level, optimum] = subject;
    const auto interval = nsma::relaxed_interval(set, shift, objective != Objective::min_energy);
    if (interval.failed || interval.empty) return std::nullopt;
    Resolved result;
    std::vector<Eigen::VectorXd> ties;
    if (objective == Objective::min_energy) {
        result.value = interval.least;
        result.beta = interval.least_point;
    } else if (objective == Objective::max_energy) {
        result.value = interval.greatest;
        result.beta = interval.vertices.front();
        for (const auto& vertex : interval.vertices) {
            if (set.energy(vertex) >= interval.greatest * (1 - 1e-12)) ties.push_back(vertex);
        }
    } else {
        nsma::RelaxedRequest request;
        request.objective = objective;
        request.level = *level;
        request.shift = shift;
        request.near = nsma::tied_optima(set, objective, optimum.beta()).others;  // judged by price_spectrum_test
        request.near.push_back(optimum.beta());
        // Near an end of the energies the orbits may lie on any side of it: all are tried.
        const double wanted = *level + shift.level;
        if (wanted < 1.001 * interval.least || (!interval.unbounded && wanted > 0.999 * interval.greatest)) {
            request.near.insert(request.near.end(), interval.vertices.begin(), interval.vertices.end());
        }
        const auto found = nsma::relaxed_optimum(set, interval, request);
        if (!found) return std::nullopt;
        result.value = found->objective;
        result.beta = found->beta;
    }
    ties.push_back(result.beta);
    for (const auto& beta : ties) {
        result.held.push_back(held_rows(set, beta, shift));
        result.held.push_back(held_rows(set, time_reversed(set.kernel, beta), shift));
    }
    return result;
}

bool same_rows(const Resolved& a, const Resolved& b) {
    return std::any_of(a.held.begin(), a.held.end(),
                       [&](const auto& rows) { return std::find(b.held.begin(), b.held.end(), rows) != b.held.end(); });
}

// As many rows of each condition: the same, or those of an orbit tied by a symmetry.
bool alike(const RelaxedSet& set, const Resolved& a, const Resolved& b) {
    const auto flights = [&](const std::vector<int>& rows) {
        return std::count_if(rows.begin(), rows.end(), [&](int i) {
            return set.condition[static_cast<std::size_t>(i)].condition == nsma::ConditionRow::Condition::cond1;
        });
    };
    const auto& one = a.held.front();
    const auto& other = b.held.front();
    return one.size() == other.size() && flights(one) == flights(other);
}

// Down to steps of 1e-4/8^4 = 2e-8 of order one, where rounding is 1e-8 of the difference.
constexpr int shrinks = 5;

// Central differences at h and h/2, extrapolated: the error is of order h^4.
std::optional<double> central(const Subject& subject, const Shift& direction, double step) {
    for (int shrink = 0; shrink < shrinks; ++shrink, step /= 8) {
        std::vector<Resolved> at;
        for (const double t : {step, -step, step / 2, -step / 2}) {
            if (auto there = resolve(subject, times(direction, t))) at.push_back(std::move(*there));
        }
        if (at.size() < 4) continue;
        if (!same_rows(at[0], at[1]) || !same_rows(at[0], at[2]) || !same_rows(at[0], at[3])) continue;
        return (4 * (at[2].value - at[3].value) / step - (at[0].value - at[1].value) / (2 * step)) / 3;
    }
    return std::nullopt;
}

// One-sided differences at h, h/2 and h/4, extrapolated twice: the error is of order h^3.
// `root`: of a square root, where the error is of order h^(3/2). NaN when the value jumps: another
// vertex of the same energy, which no climb had found, is better, so that this is no optimum.
std::optional<double> one_sided(const Subject& subject, const Shift& direction, double step, bool root) {
    for (int shrink = 0; shrink < shrinks; ++shrink, step /= 8) {
        std::vector<Resolved> at;
        std::vector<double> quotient;
        for (const double t : {step, step / 4, step / 16}) {
            auto there = resolve(subject, times(direction, t));
            if (!there) break;
            const double change = there->value - subject.optimum.value();
            if (subject.level && !root && change < -0.02 * subject.optimum.value()) return std::nan("");
            quotient.push_back(change / (root ? std::sqrt(t) : t));
            at.push_back(std::move(*there));
        }
        if (at.size() < 3 || !alike(subject.set, at[0], at[1]) || !alike(subject.set, at[0], at[2])) continue;
        const double order = root ? 2 : 4;
        const double first = (order * quotient[1] - quotient[0]) / (order - 1);
        const double second = (order * quotient[2] - quotient[1]) / (order - 1);
        return (order * order * second - first) / (order * order - 1);
    }
    return std::nullopt;
}

struct Named {
    std::string name;
    Shift direction;
    double step;  ///< first step tried
};

std::vector<Named> directions(const RelaxedSet& set, std::optional<double> level, bool rows) {
    std::vector<Named> result;
    // Linear programs tell vertices apart from 1e-6 on: larger steps at the ends.
    const double step = level ? 1e-4 : 1e-2;
    Shift gap, contact, energy;
    gap.gap = 1;
    contact.contact = 1;
    energy.level = 1;
    result.push_back({"gap", gap, step});
    result.push_back({"contact", contact, step});
    if (level) result.push_back({"energy", energy, 1e-4 * *level});
    Shift penetration, adhesion;
    penetration.rows = set.shift({1, 0, 0}).rows;
    adhesion.rows = set.shift({0, 0, 1}).rows;
    result.push_back({"penetration", penetration, step});
    result.push_back({"adhesion", adhesion, step});
    for (Eigen::Index i = 0; rows && i < set.rows.rows(); ++i) {
        Shift row;
        row.rows = Eigen::VectorXd::Zero(set.rows.rows());
        row.rows[i] = 1;
        result.push_back({"row " + std::to_string(i), row, step});
    }
    return result;
}

TEST(ShadowPrices, AgreeWithCentralDifferences) {
    int optima = 0, compared = 0, unsolved = 0, orbits = 0;
    double worst = 0, worst_orbit = 0;
    nsma::OrbitSolver solver(quick());
    for (const auto& item : cases(cells_few, 1)) {
        for (const double ratio : {0.0, 1.15, 1.3, 2.5, 5.0}) {
            const std::optional<double> level =
                ratio > 0 ? std::optional(ratio * *item.problem.interval.least) : std::nullopt;
            nsma::OrbitRequest request;
            request.level = level;
            request.objective = level ? Objective::least_shock : Objective::min_energy;
            const auto answer = solver.solve(nsma::Bar{}, item.problem, request);
            if (!answer.orbit) continue;
            const OptimumSensitivity optimum(item.set, request.objective, level, answer.orbit->beta);
            if (!optimum.nondegenerate()) continue;
            ++optima;
            const Subject subject{item.set, request.objective, level, optimum};
            for (const auto& [name, direction, step] : directions(item.set, level, true)) {
                const Slope slope = optimum.slope(direction);
                if (slope.kind != Slope::Kind::two_sided) continue;  // a tie: see below
                // A price of zero has no relative error.
                if (std::abs(*slope.right) < 1e-3 * optimum.value()) continue;
                const auto difference = central(subject, direction, step);
                if (!difference) {
                    ++unsolved;
                    continue;
                }
                ++compared;
                const double error = std::abs(*difference - *slope.right) / std::abs(*slope.right);
                worst = std::max(worst, error);
                EXPECT_LT(error, 1e-5) << name << " of " << subject.words() << ": " << *slope.right << " against "
                                       << *difference;
                if (name.rfind("row", 0) == 0 || optimum.tied() > 1) continue;
                const auto derivative = optimum.orbit_slope(direction);
                ASSERT_TRUE(derivative.beta) << derivative.reason;
                std::vector<Resolved> at;
                for (const double h : {1e-4, -1e-4, 5e-5, -5e-5}) {
                    if (auto there = resolve(subject, times(direction, h))) at.push_back(std::move(*there));
                }
                // An active set that changes on the way has no derivative to compare with.
                if (at.size() < 4 || at[0].held != at[1].held || at[0].held != at[2].held) continue;
                ++orbits;
                const Eigen::VectorXd rate = (8 * (at[2].beta - at[3].beta) - (at[0].beta - at[1].beta)) / 6e-4;
                const double off = (rate - *derivative.beta).norm() / derivative.beta->norm();
                worst_orbit = std::max(worst_orbit, off);
                EXPECT_LT(off, 1e-5) << name << " of " << subject.words();
            }
        }
    }
    std::printf("%d optima, %d prices compared: worst %.1e, %d not solved again; %d orbit derivatives: worst %.1e\n",
                optima, compared, worst, unsolved, orbits, worst_orbit);
    EXPECT_EQ(unsolved, 0);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_GE(compared, 80);
    EXPECT_GT(orbits, 40);
#endif
}

// Compares each side of a one-sided slope; returns how many it compared.
int compare_sides(const Subject& subject, const Named& named, const Slope& slope, double& worst) {
    int compared = 0;
    for (const double side : {1.0, -1.0}) {
        const auto& finite = side > 0 ? slope.right : slope.left;
        const auto& root = side > 0 ? slope.right_root : slope.left_root;
        const Shift way = times(named.direction, side);
        const std::string where = named.name + " of " + subject.words() + (side > 0 ? ", right" : ", left");
        if (!finite && !root) {
            // Refused, or no orbit there.
            const auto& reason = slope.reason;
            const bool none = reason.find((side > 0 ? "right: no orbit" : "left: no orbit")) != std::string::npos;
            if (none && subject.objective != Objective::max_energy) {
                EXPECT_FALSE(resolve(subject, times(way, named.step))) << where;
            }
            continue;
        }
        const auto difference = one_sided(subject, way, named.step, root.has_value());
        if (!difference) {
            ADD_FAILURE() << where << ": no orbit where a slope is given";
            continue;
        }
        // finite: V(0) - V(-t) = left t, so the difference along -direction is -left
        const double expected = root ? *root : side * *finite;
        if (std::isnan(*difference)) continue;
        ++compared;
        const double size = std::abs(expected) + 1e-3 * subject.optimum.value();
        const double error = std::abs(*difference - expected) / size;
        worst = std::max(worst, error);
        EXPECT_LT(error, 1e-5) << where << ": " << expected << " against " << *difference;
    }
    return compared;
}

// Ends of the energy interval as optima of the energy itself, vertices with ties among them.
TEST(ShadowPrices, EndsOfTheIntervalAgreeWithOneSidedDifferences) {
    int compared = 0;
    double worst = 0;
    for (const auto& item : cases(cells_few, 1)) {
        const auto interval = nsma::relaxed_interval(item.set);
        std::vector<std::pair<Objective, OptimumSensitivity>> ends;
        ends.emplace_back(Objective::min_energy,
                          OptimumSensitivity(item.set, Objective::min_energy, std::nullopt, interval.least_point));
        if (!interval.unbounded) {
            ends.emplace_back(Objective::max_energy, OptimumSensitivity(item.set, Objective::max_energy, std::nullopt,
                                                                        interval.vertices.front()));
        }
        for (const auto& [objective, optimum] : ends) {
            const Subject subject{item.set, objective, std::nullopt, optimum};
            EXPECT_EQ(optimum.refusal(), "") << subject.words();
            EXPECT_LT(optimum.euler_defect().value_or(1), 1e-8) << subject.words();
            for (const auto& named : directions(item.set, std::nullopt, false)) {
                const Slope slope = optimum.slope(named.direction);
                if (slope.kind == Slope::Kind::one_sided) compared += compare_sides(subject, named, slope, worst);
            }
        }
    }
    std::printf("%d one-sided derivatives of ends: worst %.1e\n", compared, worst);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_GE(compared, 20);
#endif
}

// Optima at a level that is an end of the interval: the least energy (square root) and vertices of the greatest.
TEST(ShadowPrices, DegenerateLevelsAgreeWithOneSidedDifferences) {
    int least = 0, vertices = 0;
    double worst = 0;
    for (const auto& item : cases(cells_few, 1)) {
        const auto interval = nsma::relaxed_interval(item.set);
        const auto visit = [&](double level, const Eigen::VectorXd& beta, int& compared) {
            const OptimumSensitivity optimum(item.set, Objective::least_shock, level, beta);
            if (!optimum.refusal().empty()) return;
            const Subject subject{item.set, Objective::least_shock, level, optimum};
            for (const auto& named : directions(item.set, level, false)) {
                const Slope slope = optimum.slope(named.direction);
                if (slope.kind == Slope::Kind::one_sided) compared += compare_sides(subject, named, slope, worst);
            }
        };
        visit(interval.least, interval.least_point, least);
        if (!interval.unbounded && interval.greatest > interval.least * (1 + 1e-9)) {
            // The orbits of the greatest energy are its vertices; the best of them are the optima.
            const auto shock = [&](const Eigen::VectorXd& beta) {
                return nsma::objective_of_waves(item.set.kernel, Objective::least_shock, beta);
            };
            Eigen::VectorXd best = interval.vertices.front();
            for (const auto& vertex : interval.vertices) {
                if (item.set.energy(vertex) < interval.greatest * (1 - 1e-10)) continue;
                if (shock(vertex) < shock(best) * (1 - 1e-10)) best = vertex;
            }
            visit(interval.greatest, best, vertices);
        }
    }
    std::printf("one-sided at a level: %d at the least energy, %d at vertices; worst %.1e\n", least, vertices, worst);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_GE(least, 8);
    EXPECT_GE(vertices, 10);
#endif
}

// Twelve cells more than the others: a multiplier system of 20 unknowns where CLP, given free
// unknowns, called a point optimal that was not.
TEST(ShadowPrices, GapDerivativeOfALongContact) {
    const RelaxedSet set = nsma::relaxed_set(nsma::exact_kernel({20, 60, 10}), 1);
    nsma::PatternOptions options;
    options.prove = false;
    nsma::OrbitSolver solver(quick());
    nsma::OrbitRequest request;
    request.level = 12.6;
    const auto answer = solver.solve(nsma::Bar{}, nsma::pattern_problem({20, 60, 10}, 1, options), request);
    ASSERT_TRUE(answer.orbit);
    const OptimumSensitivity optimum(set, Objective::least_shock, request.level, answer.orbit->beta);
    Shift gap;
    gap.gap = 1;
    const Slope slope = optimum.slope(gap);
    ASSERT_TRUE(slope.right && slope.left) << slope.reason;
    EXPECT_NEAR(*slope.right, -38.70, 0.005);
    EXPECT_NEAR(*slope.left, -38.70, 0.005);
}

TEST(ShadowPrices, TheBandOpensOneWay) {
    const RelaxedSet set = nsma::relaxed_set(nsma::exact_kernel({6, 16, 4}), 1);
    const auto interval = nsma::relaxed_interval(set);
    const OptimumSensitivity least(set, Objective::min_energy, std::nullopt, interval.least_point);
    ASSERT_EQ(least.refusal(), "");
    Shift contact, band;
    contact.contact = 1;
    band.band = 1;
    const Slope moved = least.slope(contact);
    ASSERT_EQ(moved.kind, Slope::Kind::two_sided);
    EXPECT_NEAR(*moved.right, 2 * interval.least, 1e-9 * interval.least);  // no other row holds it: E ~ d^2
    const Slope opened = least.slope(band);
    ASSERT_TRUE(opened.right);
    EXPECT_NEAR(*opened.right, -2 * interval.least, 1e-8 * interval.least);
    EXPECT_FALSE(opened.left);
}

TEST(ShadowPrices, RefusesMisuse) {
    const RelaxedSet set = nsma::relaxed_set(nsma::exact_kernel({6, 16, 4}), 1);
    const Eigen::VectorXd beta = Eigen::VectorXd::Zero(set.dimension());
    EXPECT_THROW(OptimumSensitivity(set, Objective::least_shock, std::nullopt, beta), std::invalid_argument);
    EXPECT_THROW(OptimumSensitivity(set, Objective::min_energy, 1.0, beta), std::invalid_argument);
    EXPECT_THROW(OptimumSensitivity(set, Objective::least_shock, 1.0, Eigen::VectorXd(1)), std::invalid_argument);
}

}  // namespace
