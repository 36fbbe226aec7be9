#include "nsma/set/reduction.hpp"

#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace {

using Eigen::VectorXd;
using Eigen::VectorXi;
using nsma::conditions;
using nsma::exact_kernel;
using nsma::Kernel;
using nsma::Pattern;
using nsma::reduce;
using nsma::Reduction;

/// Patterns of the exhaustive tests: every (r, p) of these meshes with n_T <= 24.
std::vector<Pattern> small_patterns() {
    std::vector<Pattern> patterns;
    for (int cells = 1; cells <= 6; ++cells) {
        for (int period = 2; period <= 24; ++period) {
            for (int contact = 1; contact < period; ++contact) {
                patterns.push_back({cells, period - contact, contact});
            }
        }
    }
    return patterns;
}

int wave(const Kernel& kernel, const VectorXi& beta, int n) {
    n %= kernel.pattern.period_steps();
    const int column = kernel.column(n);
    return column < 0 ? 0 : kernel.sign[static_cast<std::size_t>(n)] * beta[column];
}

/// x_n = -sum of the 2N waves from step n on.
int tip(const Kernel& kernel, const VectorXi& beta, int n) {
    int sum = 0;
    for (int k = n; k < n + 2 * kernel.pattern.cells; ++k) sum -= wave(kernel, beta, k);
    return sum;
}

/// COND1-3 word by word for the point beta/scale, in integers: no tolerance.
bool literally_admissible(const Kernel& kernel, int gap_sign, const VectorXi& beta, int scale) {
    const int r = kernel.pattern.free_steps;
    const int period = kernel.pattern.period_steps();
    for (int n = 0; n <= r; ++n) {
        if (tip(kernel, beta, n) > gap_sign * scale) return false;
    }
    for (int n = r + 1; n <= period; ++n) {
        if (tip(kernel, beta, n) != gap_sign * scale) return false;
    }
    for (int n = r; n < period; ++n) {
        if (wave(kernel, beta, n) < 0) return false;
    }
    return true;
}

bool in_reduced_set(const Reduction& reduction, const VectorXi& beta, int scale) {
    if (!reduction.empty_because.empty()) return reduction.gap_sign == 0 && beta.isZero();
    VectorXi gamma(reduction.variables());
    VectorXi rest = beta;
    for (int j = 0; j < reduction.variables(); ++j) {
        gamma[j] = reduction.flip * beta[j];
        rest[j] = 0;
        if (reduction.bounded && gamma[j] < 0) return false;
    }
    if (!rest.isZero()) return false;  // columns taken out are zero
    if (reduction.contact_row.dot(gamma) != reduction.gap_sign * scale) return false;
    return reduction.rows.rows() == 0 || (reduction.rows * gamma).maxCoeff() <= 0;
}

/// The point (in integers) with its scale: COND2 is met whenever the tip has the sign of the gap.
int scale_of(const Kernel& kernel, int gap_sign, const VectorXi& beta) {
    return gap_sign == 0 ? 1 : std::max(1, std::abs(tip(kernel, beta, 0)));
}

/// All of {-1, 0, 1}^m for m <= 5, else 300 draws from {-2..2}^m, half of them with the signs of
/// COND3 so that admissible points are among them.
std::vector<VectorXi> trial_points(const nsma::Conditions& limits, std::mt19937& random) {
    const int m = limits.dimension();
    std::vector<VectorXi> points;
    if (m <= 5) {
        int count = 1;
        for (int j = 0; j < m; ++j) count *= 3;
        for (int code = 0; code < count; ++code) {
            VectorXi beta(m);
            for (int j = 0, rest = code; j < m; ++j, rest /= 3) beta[j] = rest % 3 - 1;
            points.push_back(beta);
        }
        return points;
    }
    std::uniform_int_distribution<int> draw(-2, 2);
    for (int i = 0; i < 300; ++i) {
        VectorXi beta(m);
        for (int j = 0; j < m; ++j) {
            beta[j] = draw(random);
            if (i % 2 == 0) continue;
            switch (limits.bound_of[static_cast<std::size_t>(j)]) {
                case nsma::Conditions::Sign::nonnegative: beta[j] = std::abs(beta[j]); break;
                case nsma::Conditions::Sign::nonpositive: beta[j] = -std::abs(beta[j]); break;
                case nsma::Conditions::Sign::zero: beta[j] = 0; break;
                case nsma::Conditions::Sign::free: break;
            }
        }
        points.push_back(beta);
    }
    return points;
}

TEST(Reduction, KeepsExactlyTheAdmissiblePoints) {
    std::mt19937 random(1);
    long inside = 0;
    long outside = 0;
    for (const Pattern& pattern : small_patterns()) {
        const Kernel kernel = exact_kernel(pattern);
        if (kernel.dimension() == 0) continue;
        for (const int gap_sign : {-1, 0, 1}) {
            const auto limits = conditions(kernel, gap_sign);
            const Reduction reduction = reduce(limits);
            for (const VectorXi& beta : trial_points(limits, random)) {
                const int scale = scale_of(kernel, gap_sign, beta);
                const bool literal = literally_admissible(kernel, gap_sign, beta, scale);
                ASSERT_EQ(in_reduced_set(reduction, beta, scale), literal)
                    << "N = " << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps
                    << ") gap " << gap_sign << " beta " << beta.transpose();
                ++(literal ? inside : outside);
            }
        }
    }
    // Both outcomes must have been met often, or the comparison says nothing.
    EXPECT_GT(inside, 2000);
    EXPECT_GT(outside, 10'000);
}

TEST(Reduction, EveryRowIsAccountedFor) {
    for (const Pattern& pattern : small_patterns()) {
        for (const int gap_sign : {-1, 0, 1}) {
            const Kernel kernel = exact_kernel(pattern);
            const Reduction reduction = reduce(conditions(kernel, gap_sign));
            const auto& removed = reduction.removed;
            const int m = kernel.dimension();
            EXPECT_EQ(reduction.kernel_dimension, m);
            EXPECT_EQ(reduction.gap_sign, gap_sign);
            EXPECT_EQ(removed.dead_classes + m, pattern.class_count());
            EXPECT_EQ(removed.sign_conflicts + removed.forced_zero + reduction.variables(), m);
            EXPECT_EQ(removed.forced_zero, static_cast<int>(reduction.forced.size()));
            EXPECT_EQ(removed.force_rows, pattern.contact_steps);
            EXPECT_EQ(reduction.row_step.size(), static_cast<std::size_t>(reduction.rows.rows()));
            for (const int n : reduction.row_step) {
                EXPECT_GE(n, 1);
                EXPECT_LT(n, pattern.free_steps);
            }
            if (!reduction.empty_because.empty()) continue;  // rows are not looked at
            // COND1 has r + 1 rows and COND2 p; one row of COND2 is kept.
            EXPECT_EQ(1 + removed.contact_duplicates + removed.silent_rows + removed.implied_rows +
                          removed.duplicate_rows + removed.dominated_rows + reduction.rows.rows(),
                      pattern.period_steps() + 1);
        }
    }
}

TEST(Reduction, KeptRowsAreHalfTheTipsRiseSinceTheWallInEveryBasisVector) {
    for (const Pattern& pattern : small_patterns()) {
        const Kernel kernel = exact_kernel(pattern);
        const Reduction reduction = reduce(conditions(kernel, 1));
        for (int j = 0; j < reduction.variables(); ++j) {
            VectorXd unit = VectorXd::Zero(reduction.variables());
            unit[j] = 1;
            const VectorXi beta = reduction.beta(unit).cast<int>();
            EXPECT_EQ(reduction.contact_row[j], tip(kernel, beta, 0));
            for (Eigen::Index i = 0; i < reduction.rows.rows(); ++i) {
                const int n = reduction.row_step[static_cast<std::size_t>(i)];
                EXPECT_EQ(2 * reduction.rows(i, j), tip(kernel, beta, n) - tip(kernel, beta, 0));
            }
        }
    }
}

TEST(Reduction, ForcedZerosFollowFromARowOfPositiveTerms) {
    int forced = 0;
    for (const Pattern& pattern : small_patterns()) {
        const Kernel kernel = exact_kernel(pattern);
        const auto limits = conditions(kernel, 1);
        using Sign = nsma::Conditions::Sign;
        std::vector<char> zero;
        for (const Sign sign : limits.bound_of) zero.push_back(sign == Sign::zero ? 1 : 0);
        for (const auto& entry : reduce(limits).forced) {
            ++forced;
            // sum_{k < step} eps_k beta <= 0 over the columns not yet zero.
            VectorXi row = VectorXi::Zero(limits.dimension());
            for (int k = 0; k < entry.step; ++k) {
                const int column = kernel.column(k);
                if (column >= 0) row[column] += kernel.sign[static_cast<std::size_t>(k)];
            }
            for (int j = 0; j < limits.dimension(); ++j) {
                const auto c = static_cast<std::size_t>(j);
                if (zero[c] != 0 || row[j] == 0) continue;
                EXPECT_NE(limits.bound_of[c], Sign::free);
                EXPECT_EQ(row[j] > 0, limits.bound_of[c] == Sign::nonnegative);
            }
            EXPECT_NE(row[entry.column], 0);
            EXPECT_LT(entry.step, pattern.free_steps);
            zero[static_cast<std::size_t>(entry.column)] = 1;
        }
    }
    EXPECT_GT(forced, 100);  // the argument is used at all
}

TEST(Reduction, SignConflictByHand) {
    // N = 5, (4, 3): one class whose contact steps 4, 5, 6 carry + - +: zero, hence nothing left.
    const Reduction reduction = reduce(conditions(exact_kernel({5, 4, 3}), 1));
    EXPECT_EQ(reduction.removed.sign_conflicts, 1);
    EXPECT_EQ(reduction.variables(), 0);
    EXPECT_FALSE(reduction.empty_because.empty());
}

TEST(Reduction, FirstModeByHand) {
    // N = 6, (16, 4): beta_j <= 0 for four classes; x_0 = -sum beta = sum gamma. The tip leaves
    // with - gamma at once (eps_0 = +1, flipped) and comes back only at step r: no row is left.
    const Reduction reduction = reduce(conditions(exact_kernel({6, 16, 4}), 1));
    EXPECT_TRUE(reduction.empty_because.empty());
    EXPECT_EQ(reduction.contact_row, VectorXi::Constant(4, 1));
    EXPECT_EQ(reduction.flip, -1);
    EXPECT_TRUE(reduction.bounded);
    EXPECT_EQ(reduction.energy_factor, 36.0);
    EXPECT_EQ(reduction.rows.rows(), 0);
    EXPECT_EQ(reduction.beta(Eigen::Vector4d(1, 2, 3, 4)), VectorXd(-Eigen::Vector4d(1, 2, 3, 4)));
    // Pressed the other way the tip cannot be on the other side.
    EXPECT_FALSE(reduce(conditions(exact_kernel({6, 16, 4}), -1)).empty_because.empty());
}

TEST(Reduction, TrivialKernelIsEmptyByName) {
    // N = 1, (1, 2): g = 1, one free step: the only class is dead.
    const Reduction reduction = reduce(conditions(exact_kernel({1, 1, 2}), 1));
    EXPECT_EQ(reduction.kernel_dimension, 0);
    EXPECT_EQ(reduction.empty_because, "the kernel is trivial");
}

}  // namespace
