#include "nsma/study/sensitivity/sensitivity.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "nsma/search/pattern_problem.hpp"
#include "price/relaxed_solver.hpp"

namespace {

using nsma::AblationRecord;
using nsma::Parameter;
using nsma::Scene;
using nsma::Slope;

nsma::SensitivityRequest quick() {
    nsma::SensitivityRequest request;
    request.solver.solvers = nsma::SolverChoice::nlopt;
    request.solver.starts = 4;
    request.amounts = {0, 0.01, 0.1};
    return request;
}

Scene mode_scene() {
    Scene scene;
    scene.mesh.cells = 10;
    scene.patterns = nsma::ModeSelection{1};
    scene.levels = {3.0, 20.0};
    return scene;
}

bool always() { return true; }

// Curves start with the slope that the multipliers predict.
TEST(Sensitivity, CurvesStartWithThePredictedSlope) {
    const Scene scene = mode_scene();
    auto request = quick();
    request.amounts = {0, 1e-4, 2e-4};
    const auto seen = nsma::sensitivity(scene, request, always, [](long done, long total) { EXPECT_LE(done, total); });
    const auto& summary = seen.summary;
    EXPECT_EQ(summary.failed, 0);
    EXPECT_LT(summary.worst_euler, 1e-8);
    int compared = 0;
    for (const auto& interval : seen.intervals) {
        for (const auto& price : interval.least_prices) {
            if (!price.slope.right) continue;
            double curve[3] = {0, 0, 0};
            int found = 0;
            for (const auto& point : seen.curves) {
                if (!(point.pattern == interval.pattern) || point.relaxed != nsma::name(price.parameter)) continue;
                if (found < 3 && point.least) curve[found++] = *point.least;
            }
            if (found < 3) continue;
            ++compared;
            const double slope = (4 * (curve[1] - curve[0]) - (curve[2] - curve[0])) / 2e-4;
            EXPECT_NEAR(slope, *price.slope.right,
                        1e-4 * (std::abs(slope) + interval.least));  // second differences of E over steps of 1e-4
        }
    }
    EXPECT_GT(compared, 5);
}

// Frequency at fixed energy: the closed form against neighbours on the mesh, whose least energies
// come from the program. In s = E^(-1/2) the period is linear, so differences are exact.
TEST(Sensitivity, FrequencyAtFixedEnergyIsThatOfTheClosedForm) {
    int compared = 0;
    for (const double gap : {1.0, -1.0}) {
        Scene scene = mode_scene();
        scene.bar.gap = gap;
        auto request = quick();
        request.amounts.clear();
        const auto seen = nsma::sensitivity(scene, request, always);
        for (const auto& record : seen.intervals) {
            ASSERT_EQ(record.mode, 1);
            if (!record.frequency_by_energy_difference) continue;
            ++compared;
            EXPECT_NEAR(*record.frequency_by_energy, *record.frequency_by_energy_difference,
                        1e-9 * std::abs(*record.frequency_by_energy));
            // Stiffening for d > 0: more energy, higher frequency.
            EXPECT_GT(gap * *record.frequency_by_energy, 0);
        }
    }
    EXPECT_GT(compared, 10);
}

// Each condition only removes; all together they are the verdict of the scan.
TEST(Sensitivity, AblationIsMonotoneAndEndsAtTheVerdict) {
    int admissible = 0, live = 0;
    for (const int gap_sign : {1, 0, -1}) {
        for (const auto& pattern : nsma::patterns_in(6, {2, 24, 1, nsma::max_period_steps})) {
            const auto kernel = nsma::exact_kernel(pattern);
            const AblationRecord record = nsma::ablation_record(kernel, gap_sign);
            EXPECT_EQ(record.survives[0], kernel.dimension() > 0);
            for (unsigned kept = 0; kept < 8; ++kept) {
                for (const unsigned more : {1U, 2U, 4U}) {
                    EXPECT_LE(record.survives[kept | more], record.survives[kept]);
                }
            }
            nsma::PatternOptions options;
            options.prove = false;
            const bool verdict = nsma::pattern_problem(pattern, gap_sign, options).verdict == nsma::Verdict::admissible;
            EXPECT_EQ(record.survives[7], verdict)
                << pattern.free_steps << ", " << pattern.contact_steps << ", " << gap_sign;
            if (gap_sign == 1) {
                live += record.survives[0] ? 1 : 0;
                admissible += record.survives[7] ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(live, 209);  // public counts
    EXPECT_EQ(admissible, 35);
}

// Euler's identity on every optimum of the full spectrum. NSMA_LONG_TESTS=1: as the sweep solves
// it, with both solvers and its proofs.
TEST(Sensitivity, EulersIdentityHoldsOnEveryOptimumOfTheFullSpectrum) {
    Scene scene;
#if defined(__SANITIZE_ADDRESS__)
    scene.mesh.cells = 5;
#else
    scene.mesh.cells = 12;
#endif
    scene.patterns = nsma::PeriodSelection{{0.0, 4.0}, std::nullopt};
    for (int k = 0; k < 12; ++k) scene.levels.push_back(1.05 * std::pow(100 / 1.05, k / 11.0));
    auto request = quick();
    if (std::getenv("NSMA_LONG_TESTS") != nullptr) {
        scene.mesh.cells = 12;
        request.solver = {};
    }
    request.amounts.clear();
    const auto seen = nsma::sensitivity(scene, request, always, [](long done, long total) { EXPECT_LE(done, total); });
    const auto& summary = seen.summary;
    int without = 0;
    for (const auto& optimum : seen.optima) {
        if (!optimum.euler_defect) {
            ++without;
            continue;
        }
        EXPECT_LT(*optimum.euler_defect, 1e-8);
    }
    std::printf("N = %d: %d optima, worst %.1e, without multipliers %d, nondegenerate %d, tied %d, refused %d\n",
                scene.mesh.cells, summary.optima, summary.worst_euler, without, summary.nondegenerate, summary.tied,
                summary.refused);
    EXPECT_EQ(summary.failed, 0);
    EXPECT_EQ(without, 0);
    EXPECT_GT(summary.optima, scene.mesh.cells == 12 ? 150 : 10);
    // The admissible patterns among the 1128 of N = 12, by every order of the conditions.
    if (scene.mesh.cells != 12) return;
    std::array<int, 8> survivors{};
    for (const auto& record : seen.ablations) {
        for (std::size_t kept = 0; kept < 8; ++kept) survivors.at(kept) += record.survives.at(kept) ? 1 : 0;
    }
    EXPECT_EQ(seen.ablations.size(), 1128U);
    EXPECT_EQ(survivors[0], 849);
    EXPECT_EQ(survivors[7], summary.admissible);
}

}  // namespace
