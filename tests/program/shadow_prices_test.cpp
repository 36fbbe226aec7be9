#include "nsma/program/shadow_prices.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "nsma/program/orbit_solver.hpp"
#include "nsma/program/relaxed_solver.hpp"

// Every derivative against differences of programs solved again from the shifted right-hand
// sides. NSMA_FULL=1 runs the meshes of the full study; under sanitizers a smaller mesh is enough.

namespace {

using nsma::Objective;
using nsma::OptimumSensitivity;
using nsma::RelaxedSet;
using nsma::Shift;
using nsma::Slope;

bool full() { return std::getenv("NSMA_FULL") != nullptr; }

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

// Patterns that some orbit meets, with their parametric sets.
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
        if (problem.verdict != nsma::Verdict::admissible) continue;
        RelaxedSet set = nsma::relaxed_set(problem.kernel, gap_sign);
        result.push_back({std::move(problem), std::move(set)});
    }
    return result;
}

nsma::OrbitSolverOptions quick() {
    nsma::OrbitSolverOptions options;
    options.solvers = nsma::SolverChoice::nlopt;
    options.bound_nodes = 0;
    options.starts = 4;
    return options;
}

// Value of the program solved again at t times the direction, near a known optimum.
std::optional<double> value_at(const RelaxedSet& set, Objective objective, std::optional<double> level,
                               const Eigen::VectorXd& near, const Shift& shift) {
    const auto interval = nsma::relaxed_interval(set, shift, objective != Objective::min_energy);
    if (interval.failed || interval.empty) return std::nullopt;
    if (objective == Objective::min_energy) return interval.least;
    if (objective == Objective::max_energy) return interval.greatest;
    nsma::RelaxedRequest request;
    request.objective = objective;
    request.level = level;
    request.shift = shift;
    request.near = {near, nsma::time_reversed(set.kernel, near)};
    // Near the least energy the orbits may lie on two sides: both are tried.
    if (*level + shift.level < 1.001 * interval.least) {
        request.near.insert(request.near.end(), interval.vertices.begin(), interval.vertices.end());
    }
    const auto optimum = nsma::relaxed_optimum(set, interval, request);
    if (optimum.status != nsma::RelaxedOptimum::Status::optimal) return std::nullopt;
    return optimum.objective;
}

// Central differences at steps h and h/2, extrapolated: the error is of order h^4. A stencil
// that straddles a change of the active set shows by its two steps differing; then the step
// shrinks.
std::optional<double> central(const std::function<std::optional<double>(double)>& value, double step) {
    for (int shrink = 0; shrink < 5; ++shrink, step /= 8) {
        double difference[2];
        for (int half = 0; half < 2; ++half) {
            const double h = half == 0 ? step : step / 2;
            const auto up = value(h);
            const auto down = value(-h);
            if (!up || !down) return std::nullopt;
            difference[half] = (*up - *down) / (2 * h);
        }
        const double extrapolated = (4 * difference[1] - difference[0]) / 3;
        if (std::abs(difference[1] - difference[0]) <= 1e-6 * std::abs(extrapolated)) return extrapolated;
    }
    return std::nullopt;
}

// One-sided differences at h, h/2 and h/4, extrapolated twice.
std::optional<double> one_sided(const std::function<std::optional<double>(double)>& value, double at_zero, double step) {
    double difference[3];
    for (int k = 0; k < 3; ++k) {
        const double h = step / (1 << k);
        const auto there = value(h);
        if (!there) return std::nullopt;
        difference[k] = (*there - at_zero) / h;
    }
    const double first = 2 * difference[1] - difference[0];
    const double second = 2 * difference[2] - difference[1];
    return (4 * second - first) / 3;
}

struct Named {
    const char* name;
    Shift direction;
    double step;
};

std::vector<Named> directions(const RelaxedSet& set, std::optional<double> level) {
    std::vector<Named> result;
    Shift gap, contact, energy;
    gap.gap = 1;
    contact.contact = 1;
    energy.level = 1;
    result.push_back({"gap", gap, 1e-4});
    result.push_back({"contact", contact, 1e-4});
    if (level) result.push_back({"energy", energy, 1e-4 * *level});
    Shift penetration, adhesion;
    penetration.rows = set.shift({1, 0, 0}).rows;
    adhesion.rows = set.shift({0, 0, 1}).rows;
    result.push_back({"penetration", penetration, 1e-4});
    result.push_back({"adhesion", adhesion, 1e-4});
    for (Eigen::Index i = 0; i < set.rows.rows(); ++i) {
        Shift row;
        row.rows = Eigen::VectorXd::Zero(set.rows.rows());
        row.rows[i] = 1;
        result.push_back({"row", row, 1e-4});
    }
    return result;
}

TEST(ShadowPrices, AgreeWithCentralDifferencesAndEuler) {
    int compared = 0, optima = 0, orbits = 0;
    double worst = 0, worst_euler = 0, worst_orbit = 0;
    std::map<std::string, int> refused;
    for (const int cells : full() ? std::vector{8, 12} : std::vector{cells_few}) {
        nsma::OrbitSolver solver(quick());
        for (const auto& item : cases(cells, 1)) {
            for (const double ratio : {0.0, 1.15, 1.3, 2.0, 4.0}) {
                const std::optional<double> level =
                    ratio > 0 ? std::optional(ratio * *item.problem.interval.least) : std::nullopt;
                const Objective objective = level ? Objective::least_shock : Objective::min_energy;
                nsma::OrbitRequest request;
                request.level = level;
                request.objective = objective;
                const auto answer = solver.solve(nsma::Bar{}, item.problem, request);
                if (!answer.orbit) continue;
                const OptimumSensitivity optimum(item.set, objective, level, answer.orbit->beta);
                if (!optimum.refusal().empty()) {
                    ++refused[optimum.refusal()];
                    continue;
                }
                ++optima;
                if (const auto defect = optimum.euler_defect()) worst_euler = std::max(worst_euler, *defect);
                for (const auto& [name, direction, step] : directions(item.set, level)) {
                    const Slope slope = optimum.slope(direction);
                    // A price of zero has no relative error; other tests look at those.
                    if (slope.kind != Slope::Kind::two_sided || std::abs(*slope.right) < 1e-3 * optimum.value()) continue;
                    const auto difference = central(
                        [&, way = direction](double t) {
                            return value_at(item.set, objective, level, optimum.beta(), times(way, t));
                        },
                        step);
                    if (!difference) continue;
                    ++compared;
                    const double error = std::abs(*difference - *slope.right) / std::abs(*slope.right);
                    worst = std::max(worst, error);
                    EXPECT_LT(error, 1e-5) << name << " of (" << cells << ", " << item.set.kernel.pattern.free_steps << ", "
                                           << item.set.kernel.pattern.contact_steps << ") at " << level.value_or(0)
                                           << ": " << *slope.right << " against " << *difference;
                    if (std::string(name) == "row" || optimum.tied()) continue;
                    const auto derivative = optimum.orbit_slope(direction);
                    if (!derivative.beta) continue;
                    // The orbit itself, by central differences of the orbits solved again.
                    Eigen::VectorXd ends[2];
                    for (int side = 0; side < 2; ++side) {
                        const Shift shift = times(direction, side == 0 ? 0.1 * step : -0.1 * step);
                        const auto interval = nsma::relaxed_interval(item.set, shift);
                        nsma::RelaxedRequest near;
                        near.objective = objective;
                        near.level = level;
                        near.shift = shift;
                        near.near = {optimum.beta()};
                        ends[side] = nsma::relaxed_optimum(item.set, interval, near).beta;
                    }
                    if (ends[0].size() == 0 || ends[1].size() == 0) continue;
                    ++orbits;
                    const Eigen::VectorXd rate = (ends[0] - ends[1]) / (0.2 * step);
                    const double off = (rate - *derivative.beta).norm() / derivative.beta->norm();
                    worst_orbit = std::max(worst_orbit, off);
                    EXPECT_LT(off, 1e-4) << name;  // steps of 1e-5, where an active set may change
                }
            }
        }
    }
    RecordProperty("compared", compared);
    std::printf("%d optima, %d prices compared: worst %.1e; Euler %.1e; %d orbit derivatives: worst %.1e\n", optima,
                compared, worst, worst_euler, orbits, worst_orbit);
    for (const auto& [why, count] : refused) std::printf("refused %d: %s\n", count, why.c_str());
    EXPECT_LT(worst_euler, 1e-8);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_GE(compared, 200);
    EXPECT_GT(orbits, 20);
#endif
}

// Vertices (the greatest energy, where several may tie) and the least energy of degenerate sets:
// the sides differ, and each agrees with its own differences.
TEST(ShadowPrices, OneSidedDerivativesAgreeWithOneSidedDifferences) {
    int compared = 0, unequal = 0;
    double worst = 0;
    for (const auto& item : cases(cells_few, 1)) {
        const auto interval = nsma::relaxed_interval(item.set);
        std::vector<std::pair<Objective, OptimumSensitivity>> ends;
        ends.emplace_back(Objective::min_energy,
                          OptimumSensitivity(item.set, Objective::min_energy, std::nullopt, interval.least_point));
        if (!interval.unbounded) {
            std::vector<Eigen::VectorXd> ties;
            for (const auto& vertex : interval.vertices) {
                if (item.set.energy(vertex) >= interval.greatest * (1 - 1e-10)) ties.push_back(vertex);
            }
            ends.emplace_back(Objective::max_energy,
                              OptimumSensitivity(item.set, Objective::max_energy, std::nullopt, interval.vertices.front(),
                                                 {}, {}, ties));
        }
        for (const auto& [objective, optimum] : ends) {
            if (!optimum.refusal().empty()) continue;
            for (const auto& [name, direction, step] : directions(item.set, std::nullopt)) {
                const Slope slope = optimum.slope(direction);
                if (slope.kind != Slope::Kind::one_sided) continue;
                for (const double side : {1.0, -1.0}) {
                    const auto& expected = side > 0 ? slope.right : slope.left;
                    const auto value = [&, which = objective, way = direction, sign = side](double t) {
                        return value_at(item.set, which, std::nullopt, optimum.beta(), times(way, sign * t));
                    };
                    if (!expected) {
                        EXPECT_FALSE(value(1e-3).has_value()) << name;  // no orbit on that side
                        continue;
                    }
                    const auto difference = one_sided(value, optimum.value(), 10 * step);
                    if (!difference) {
                        ADD_FAILURE() << name << ": no orbit where a slope is given";
                        continue;
                    }
                    ++compared;
                    const double error = std::abs(side * *difference - *expected);
                    worst = std::max(worst, error / (std::abs(*expected) + optimum.value()));
                    EXPECT_LT(error, 1e-5 * (std::abs(*expected) + optimum.value()))
                        << name << " of (" << item.set.kernel.pattern.free_steps << ", "
                        << item.set.kernel.pattern.contact_steps << ") " << nsma::name(objective) << " side " << side
                        << ": " << *expected << " against " << side * *difference;
                }
                ++unequal;
            }
        }
    }
    std::printf("%d one-sided derivatives of %d degenerate cases: worst %.1e\n", compared, unequal, worst);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_GE(unequal, 20);
#endif
}

// At E = E_min the set of orbits is one point, and grows with the square root of the energy.
TEST(ShadowPrices, TheLeastEnergyIsASquareRoot) {
    int compared = 0;
    for (const auto& item : cases(cells_few, 1)) {
        const auto interval = nsma::relaxed_interval(item.set);
        const OptimumSensitivity optimum(item.set, Objective::least_shock, interval.least, interval.least_point);
        if (!optimum.refusal().empty()) continue;
        Shift energy;
        energy.level = 1;
        const Slope slope = optimum.slope(energy);
        if (!slope.right_root) continue;
        EXPECT_FALSE(slope.right);
        EXPECT_FALSE(slope.left);
        double ratio[2];
        bool solved = true;
        for (int k = 0; k < 2; ++k) {
            const double h = 1e-6 * interval.least / (k == 0 ? 1 : 4);
            const auto value = value_at(item.set, Objective::least_shock, interval.least, optimum.beta(), times(energy, h));
            solved = solved && value.has_value();
            if (value) ratio[k] = (*value - optimum.value()) / std::sqrt(h);
        }
        if (!solved) continue;
        ++compared;
        EXPECT_NEAR(2 * ratio[1] - ratio[0], *slope.right_root, 1e-5 * std::abs(*slope.right_root));
    }
    std::printf("%d square roots at the least energy\n", compared);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_GE(compared, 5);
#endif
}

TEST(ShadowPrices, InactiveRowsAreFreeAndTheBandOpensOneWay) {
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
