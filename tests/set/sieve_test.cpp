#include "nsma/orbit/sieve.hpp"

#include <gtest/gtest.h>

#include "nsma/orbit/backbone.hpp"

#include "../support/sieve_all.hpp"
#include "general_set.hpp"

namespace nsma {
namespace {

// The whole way round: kernel by cycles, presolve, linear program and least norm. It shares
// nothing with the sieve but the pattern.
void expect_agreement(int cells, int gap_sign, int period_hi, bool greatest) {
    Sieve sieve(cells, gap_sign);
    for (const Pattern& pattern : patterns_in(cells, {2, period_hi})) {
        const Sieved quick = sieve(pattern.free_steps, pattern.contact_steps);
        const Kernel kernel = exact_kernel(pattern);
        const AdmissibleSet set = oracle::general_set(reduce(conditions(kernel, gap_sign)));
        const auto where = testing::Message() << "N " << cells << ", (" << pattern.free_steps << ", "
                                              << pattern.contact_steps << "), gap sign " << gap_sign;
        ASSERT_EQ(quick.kernel_dimension, kernel.dimension()) << where;
        ASSERT_EQ(quick.finding == Finding::admissible, set.status == AdmissibleSet::Status::nonempty)
            << where << ": " << set.reason;
        if (quick.finding == Finding::sign_conflict) {
            EXPECT_EQ(set.reduction.removed.sign_conflicts, kernel.dimension()) << where;
        }
        if (quick.finding != Finding::admissible) continue;
        if (gap_sign == 0) {
            EXPECT_TRUE(set.unbounded()) << where;
            continue;
        }
        const EnergyInterval interval = set.interval();
        // Least squares and linear programs on integers of size <= 2N: rounding only.
        EXPECT_NEAR(*interval.least, quick.energy_least, 1e-9 * quick.energy_least) << where;
        EXPECT_EQ(interval.unbounded, quick.unbounded) << where;
        if (greatest) {
            EXPECT_NEAR(*interval.greatest, quick.energy_greatest, 1e-9 * quick.energy_greatest) << where;
        }
    }
}

TEST(Sieve, AgreesWithTheLinearPrograms) {
    for (int cells = 1; cells <= 6; ++cells) {
        for (const int gap_sign : {1, 0, -1}) expect_agreement(cells, gap_sign, 4 * cells, true);
    }
}

TEST(Sieve, AgreesBeyondFourTravelTimesAndOnOtherMeshes) {
    expect_agreement(3, 1, 40, false);
    expect_agreement(2, -1, 40, false);
    for (const int gap_sign : {1, 0, -1}) expect_agreement(10, gap_sign, 40, false);
}

TEST(Sieve, CountsOfTheProblemStatement) {
    const SieveCounts counts = sieve_all(6, 1, 24);
    EXPECT_EQ(counts.patterns(), 276);
    EXPECT_EQ(counts.patterns() - counts[Finding::trivial], 209);
    EXPECT_EQ(counts[Finding::admissible], 35);
}

TEST(Sieve, IntervalsOfTheProblemStatement) {
    Sieve sieve(6, 1);
    const Sieved mode = sieve(16, 4);
    EXPECT_EQ(mode.kernel_dimension, 4);
    EXPECT_EQ(mode.energy_least, 9.0);
    EXPECT_EQ(mode.energy_greatest, 36.0);
    const Sieved free = sieve(23, 1);
    EXPECT_EQ(free.kernel_dimension, 11);
    EXPECT_EQ(free.energy_least, 12.0 / 11.0);
}

TEST(Sieve, NonsmoothModesAreAdmissibleAtTheirEnergy) {
    for (const int cells : {20, 120, 1000}) {
        for (const int gap_sign : {1, -1}) {
            Sieve sieve(cells, gap_sign);
            for (int mode = 1; mode <= 4; ++mode) {
                for (const Pattern& pattern : mode_patterns(mode, cells, gap_sign)) {
                    const Sieved found = sieve(pattern.free_steps, pattern.contact_steps);
                    const double energy = backbone_energy_ratio(mode, pattern.period_ratio());
                    EXPECT_EQ(found.finding, Finding::admissible);
                    // The backbone is computed from T/tau in floating point near its pole.
                    EXPECT_NEAR(found.energy_least, energy, 1e-9 * energy * std::max(1.0, std::sqrt(energy) * cells));
                }
            }
        }
    }
}

TEST(Sieve, MisuseIsNamed) {
    EXPECT_THROW(Sieve(0, 1), std::invalid_argument);
    EXPECT_THROW(Sieve(6, 2), std::invalid_argument);
    Sieve sieve(6, 1);
    EXPECT_THROW((void)sieve(0, 1), std::invalid_argument);
    EXPECT_THROW((void)sieve(1, max_period_steps), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
