#include "nsma/study/sensitivity.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "nsma/program/relaxed_solver.hpp"

namespace {

using nsma::AblationRecord;
using nsma::CurveRecord;
using nsma::IntervalRecord;
using nsma::OptimumRecord;
using nsma::Parameter;
using nsma::Scene;
using nsma::Slope;

struct Recorder : nsma::SensitivitySink {
    std::vector<OptimumRecord> optima;
    std::vector<IntervalRecord> intervals;
    std::vector<CurveRecord> curves;
    std::vector<AblationRecord> ablations;
    void optimum(const OptimumRecord& record) override { optima.push_back(record); }
    void interval(const IntervalRecord& record) override { intervals.push_back(record); }
    void curve(const CurveRecord& record) override { curves.push_back(record); }
    void ablation(const AblationRecord& record) override { ablations.push_back(record); }
    void progress(long done, long total) override { EXPECT_LE(done, total); }
};

nsma::SensitivityRequest quick() {
    nsma::SensitivityRequest request;
    request.solver.solvers = nsma::SolverChoice::nlopt;
    request.solver.bound_nodes = 0;
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

// The same rod in SI units has the same elasticities; recomputed here from derivatives in SI.
TEST(Sensitivity, ElasticitiesDoNotDependOnUnits) {
    Scene unit = mode_scene();
    Scene steel = unit;
    steel.bar = {1.0, 210e9, 7850.0, 1e-4, 1e-4};
    Recorder one, other;
    (void)nsma::sensitivity(unit, quick(), one, always);
    (void)nsma::sensitivity(steel, quick(), other, always);
    ASSERT_EQ(one.optima.size(), other.optima.size());
    ASSERT_GT(one.optima.size(), 5U);
    int compared = 0;
    for (std::size_t i = 0; i < one.optima.size(); ++i) {
        const auto& a = one.optima[i];
        const auto& b = other.optima[i];
        ASSERT_EQ(a.prices.size(), b.prices.size());
        for (std::size_t k = 0; k < a.prices.size(); ++k) {
            ASSERT_EQ(a.prices[k].slope.kind, b.prices[k].slope.kind);
            if (!a.prices[k].slope.right) continue;
            const auto relative = [&](const OptimumRecord& record, const nsma::Bar& bar) {
                // objective [J] per SI unit of the parameter, then made relative again
                const auto& price = record.prices[k];
                const double si = *price.slope.right * bar.energy_unit() / nsma::unit_of(price.parameter, bar);
                const double force = bar.young_modulus * bar.area * std::abs(bar.gap) / bar.length;
                const double amount = price.parameter == Parameter::energy ? nsma::energy(record.orbit)
                                      : price.parameter == Parameter::adhesion || price.parameter == Parameter::cond3_row
                                          ? force
                                          : bar.gap;
                return si * amount / (record.value * bar.energy_unit());
            };
            ++compared;
            EXPECT_NEAR(relative(a, unit.bar), relative(b, steel.bar), 1e-10 * (1 + std::abs(relative(a, unit.bar))));
        }
    }
    std::printf("%d elasticities\n", compared);
}

// Curves start with the slope that the multipliers predict.
TEST(Sensitivity, CurvesStartWithThePredictedSlope) {
    Recorder seen;
    const Scene scene = mode_scene();
    auto request = quick();
    request.amounts = {0, 1e-4, 2e-4};
    const auto summary = nsma::sensitivity(scene, request, seen, always);
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
            EXPECT_NEAR(slope, *price.slope.right, 1e-4 * (std::abs(slope) + interval.least));  // second differences of E over steps of 1e-4
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
        Recorder seen;
        (void)nsma::sensitivity(scene, request, seen, always);
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
            EXPECT_EQ(record.survives[7], verdict) << pattern.free_steps << ", " << pattern.contact_steps << ", " << gap_sign;
            if (gap_sign == 1) {
                live += record.survives[0] ? 1 : 0;
                admissible += record.survives[7] ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(live, 209);       // public counts
    EXPECT_EQ(admissible, 35);
}

// Euler's identity on every optimum of a sweep. NSMA_FULL=1: the full spectrum at N = 12.
TEST(Sensitivity, EulersIdentityHoldsOnEveryOptimumOfASweep) {
    Scene scene;
    scene.mesh.cells = std::getenv("NSMA_FULL") != nullptr ? 12 : 5;
    scene.patterns = nsma::PeriodSelection{{0.0, 4.0}, std::nullopt};
    for (int k = 0; k < 12; ++k) scene.levels.push_back(1.05 * std::pow(100 / 1.05, k / 11.0));
    auto request = quick();
    request.amounts.clear();
    Recorder seen;
    const auto summary = nsma::sensitivity(scene, request, seen, always);
    int without = 0;
    for (const auto& optimum : seen.optima) {
        if (!optimum.euler_defect) {
            ++without;
            continue;
        }
        EXPECT_LT(*optimum.euler_defect, 1e-8);
    }
    std::printf("%d optima, worst %.1e, without multipliers %d, nondegenerate %d, tied %d\n", summary.optima,
                summary.worst_euler, without, summary.nondegenerate, summary.tied);
    EXPECT_EQ(without, 0);
    EXPECT_GT(summary.optima, 20);
}

}  // namespace
