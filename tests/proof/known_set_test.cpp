// Sets known in closed form against the linear program and the least-norm projection.
#include <vector>

#include <gtest/gtest.h>

#include "nsma/orbit/kernel.hpp"
#include "nsma/set/admissible_set.hpp"
#include "nsma/proof/prove.hpp"

#include "../set/general_set.hpp"

namespace {

using nsma::AdmissibleSet;
using nsma::Pattern;
using Shape = AdmissibleSet::Shape;
using Status = AdmissibleSet::Status;

struct Both {
    nsma::Kernel kernel;
    AdmissibleSet known;
    AdmissibleSet solved;
};

Both both(const Pattern& pattern, int gap_sign) {
    Both result{nsma::exact_kernel(pattern), {}, {}};
    const auto reduction = nsma::reduce(nsma::conditions(result.kernel, gap_sign));
    result.known = nsma::admissible_set(reduction);
    result.solved = oracle::general_set(reduction);
    return result;
}

std::vector<Pattern> patterns_of(int cells) {
    std::vector<Pattern> patterns;
    for (int period = 2; period <= 4 * cells; ++period) {
        for (int free = 1; free < period; ++free) patterns.push_back({cells, free, period - free});
    }
    return patterns;
}

TEST(KnownSet, EveryPatternOfSixCellsEqualsTheLinearProgram) {
    int simplexes = 0, chains = 0, empty = 0;
    for (int cells = 1; cells <= 6; ++cells) {
        for (const Pattern& pattern : patterns_of(cells)) {
            for (const int gap_sign : {-1, 0, 1}) {
                const Both sets = both(pattern, gap_sign);
                SCOPED_TRACE(testing::Message() << cells << " (" << pattern.free_steps << ", " << pattern.contact_steps
                                                << ") gap " << gap_sign);
                ASSERT_EQ(sets.known.status, sets.solved.status) << sets.solved.reason;
                EXPECT_EQ(sets.known.unbounded(), sets.solved.unbounded());
                if (sets.known.status == Status::empty) {
                    EXPECT_FALSE(sets.known.reason.empty());
                    ++empty;
                    continue;
                }
                ASSERT_NE(sets.known.shape, Shape::none);
                ++(sets.known.shape == Shape::simplex ? simplexes : chains);
                if (gap_sign == 0) continue;
                // The projection solves a least-squares problem, CLP works to 1e-9 and is sharpened.
                EXPECT_LT((sets.known.least - sets.solved.least).norm(), 1e-12 * sets.solved.least.norm());
                EXPECT_GE(*sets.known.interval().greatest, *sets.solved.interval().greatest * (1 - 1e-12));
            }
        }
    }
    EXPECT_GT(simplexes, 50);
    EXPECT_GT(chains, 20);
    EXPECT_GT(empty, 300);
}

TEST(KnownSet, VerticesMeetEveryConditionAndStartWithTheGreatest) {
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 18, 6}, {6, 23, 1}, {3, 11, 1}, {1, 3, 1}, {50, 140, 60}}) {
        const AdmissibleSet set = both(pattern, 1).known;
        ASSERT_FALSE(set.vertices.empty());
        for (const auto& vertex : set.vertices) {
            // Sums of -1, 0, 1: no rounding.
            EXPECT_TRUE((set.reduction.rows.cast<double>() * vertex).cwiseMax(0.0).isZero(0.0));
            EXPECT_EQ(set.reduction.contact_row.cast<double>().dot(vertex), 1.0);
            EXPECT_LE(vertex.squaredNorm(), set.vertices.front().squaredNorm());
        }
        for (std::size_t i = 0; i < set.vertices.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) EXPECT_NE(set.vertices[i], set.vertices[j]);
        }
    }
}

TEST(KnownSet, GreatestEnergyOfAChainNeedsTheZigzag) {
    // (6, 23, 1): eleven steps of size one, so 12^2/12 times 11; by hand. (50, 140, 60): m = 40, so 39.
    EXPECT_EQ(*both({6, 23, 1}, 1).known.interval().greatest, 132.0);
    const AdmissibleSet even = both({50, 140, 60}, 1).known;
    ASSERT_EQ(even.shape, Shape::chain);
    EXPECT_EQ(even.vertices.front().squaredNorm(), 39.0);
    // All of the greatest energy are kept: the zero step may stand anywhere.
    int greatest = 0;
    for (const auto& vertex : even.vertices) greatest += vertex.squaredNorm() == 39.0 ? 1 : 0;
    EXPECT_EQ(greatest, 40);
}

}  // namespace
