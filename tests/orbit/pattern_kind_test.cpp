// The kind of a pattern, by integers, against the null space of the literal scheme.
#include "nsma/orbit/pattern_kind.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "wave/dense_wfem.hpp"

namespace {

using Eigen::MatrixXd;
using nsma::Bar;
using nsma::Mesh;
using nsma::Pattern;
using nsma::PatternKind;

// What the motions of ker(A_c^p A_f^r - I) do at the contact end, stepped by the matrices of the scheme.
struct Seen {
    Eigen::Index dimension = 0;
    bool presses = false;
    bool moves = false;
};

Seen seen(const Pattern& pattern) {
    const Bar bar;
    const Mesh mesh{pattern.cells};
    const MatrixXd free = nsma::dense::free_step_matrix(bar, mesh);
    const MatrixXd contact = nsma::dense::contact_step_matrix(bar, mesh);
    const int size = 2 * pattern.cells;
    MatrixXd period = MatrixXd::Identity(size, size);
    for (int n = 0; n < pattern.free_steps; ++n) period = free * period;
    for (int n = 0; n < pattern.contact_steps; ++n) period = contact * period;
    const Eigen::JacobiSVD<MatrixXd> svd(period - MatrixXd::Identity(size, size), Eigen::ComputeFullV);
    // Singular values of such matrices are zero or above 1e-2 at these sizes; rounding is 1e-14.
    const Eigen::Index rank = (svd.singularValues().array() > 1e-9).count();
    MatrixXd states = svd.matrixV().rightCols(size - rank);
    Seen result;
    result.dimension = states.cols();
    if (states.cols() == 0) return result;
    for (int n = 0; n < pattern.period_steps(); ++n) {
        const bool flight = n < pattern.free_steps;
        // Contact end: free v* = v_N - sigma_N/z, in contact sigma* = sigma_N - z v_N; z = 1.
        const Eigen::RowVectorXd stress = states.row(pattern.cells - 1);
        const Eigen::RowVectorXd velocity = states.row(size - 1);
        const double felt = (flight ? Eigen::RowVectorXd(velocity - stress) : Eigen::RowVectorXd(stress - velocity))
                                .cwiseAbs()
                                .maxCoeff();
        if (felt > 1e-9) (flight ? result.moves : result.presses) = true;
        states = (flight ? free : contact) * states;
    }
    return result;
}

TEST(PatternKind, IsWhatTheKernelOfTheLiteralSchemeDoes) {
    int counts[3] = {0, 0, 0};
    for (int cells = 1; cells <= 6; ++cells) {
        for (int period = 2; period <= 4 * cells + 3; ++period) {
            for (int free = 1; free < period; ++free) {
                const Pattern pattern{cells, free, period - free};
                const Seen motion = seen(pattern);
                const auto kind = nsma::pattern_kind(pattern);
                SCOPED_TRACE(testing::Message() << cells << " (" << free << ", " << period - free << ")");
                ASSERT_EQ(kind.has_value(), motion.dimension > 0);
                if (!kind) continue;
                EXPECT_EQ(motion.presses, *kind != PatternKind::free);
                EXPECT_EQ(motion.moves, *kind != PatternKind::stuck);
                ++counts[static_cast<int>(*kind)];
            }
        }
    }
    for (const int count : counts) EXPECT_GT(count, 40);
}

TEST(PatternKind, ByHand) {
    // One class of four steps, its contact step dead: T = 4 tau on one cell, the free vibration that grazes.
    EXPECT_EQ(nsma::pattern_kind({1, 3, 1}), PatternKind::free);
    // First mode: both free and contact steps of every live class.
    EXPECT_EQ(nsma::pattern_kind({2, 6, 1}), PatternKind::contact);
    // g = 8 classes of one step each; the four of the flight are dead.
    EXPECT_EQ(nsma::pattern_kind({8, 4, 4}), PatternKind::stuck);
    EXPECT_FALSE(nsma::pattern_kind({1, 1, 2}));
    EXPECT_THROW((void)nsma::pattern_kind({0, 1, 1}), std::invalid_argument);
}

TEST(PatternKind, Names) {
    EXPECT_EQ(nsma::name(PatternKind::contact), "contact");
    EXPECT_EQ(nsma::name(PatternKind::free), "free");
    EXPECT_EQ(nsma::name(PatternKind::stuck), "stuck");
}

}  // namespace
