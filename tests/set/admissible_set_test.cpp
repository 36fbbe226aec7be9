#include "nsma/set/admissible_set.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "general_set.hpp"
#include "nsma/orbit/backbone.hpp"
#include "nsma/orbit/replay.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using nsma::admissible_set;
using nsma::AdmissibleSet;
using nsma::conditions;
using nsma::exact_kernel;
using nsma::Pattern;
using nsma::reduce;
using nsma::Reduction;
using Status = nsma::AdmissibleSet::Status;

AdmissibleSet set_of(const Pattern& pattern, int gap_sign) {
    return admissible_set(reduce(conditions(exact_kernel(pattern), gap_sign)));
}

std::vector<Pattern> small_patterns(int cells) {
    std::vector<Pattern> patterns;
    for (int period = 2; period <= 4 * cells; ++period) {
        for (int contact = 1; contact < period; ++contact) {
            patterns.push_back({cells, period - contact, contact});
        }
    }
    return patterns;
}

/// Rows a x <= 0 of the set, bounds among them.
MatrixXd cone_rows(const Reduction& reduction) {
    MatrixXd rows = reduction.rows.cast<double>();
    for (Eigen::Index j = 0; j < reduction.variables(); ++j) {
        if (!reduction.bounded) continue;
        rows.conservativeResize(rows.rows() + 1, reduction.variables());
        rows.row(rows.rows() - 1) = -VectorXd::Unit(reduction.variables(), j).transpose();
    }
    return rows;
}

/// Calls `visit` with every choice of `size` out of `count` rows.
void for_each_choice(Eigen::Index count, Eigen::Index size,
                     const std::function<void(const std::vector<Eigen::Index>&)>& visit) {
    std::vector<Eigen::Index> choice;
    const std::function<void(Eigen::Index)> extend = [&](Eigen::Index from) {
        if (static_cast<Eigen::Index>(choice.size()) == size) {
            visit(choice);
            return;
        }
        for (Eigen::Index i = from; i < count; ++i) {
            choice.push_back(i);
            extend(i + 1);
            choice.pop_back();
        }
    };
    extend(0);
}

/// What brute force knows of P: all its vertices, and whether it has a direction.
struct BruteForce {
    std::vector<VectorXd> vertices;
    bool direction = false;
    bool pointed = true;  ///< false: P holds a line, if anything, and has no vertices
};

// Data are integers up to 24 in at most 5 unknowns: a true slack or pivot is above 1e-6.
constexpr double slack_tolerance = 1e-9;

BruteForce enumerate(const Reduction& reduction) {
    const Eigen::Index n = reduction.variables();
    const MatrixXd rows = cone_rows(reduction);
    const VectorXd contact = reduction.contact_row.cast<double>();
    MatrixXd all(rows.rows() + 1, n);
    all << rows, contact.transpose();
    BruteForce result;
    if (Eigen::FullPivLU<MatrixXd>(all).rank() < n) {
        result.pointed = false;
        return result;
    }
    for_each_choice(rows.rows(), n - 1, [&](const auto& choice) {
        MatrixXd system(n, n);
        system << rows(choice, Eigen::all), contact.transpose();
        const Eigen::FullPivLU<MatrixXd> lu(system);
        if (!lu.isInvertible()) return;
        const VectorXd vertex = lu.solve(VectorXd::Unit(n, n - 1) * reduction.gap_sign);
        if (rows.rows() == 0 || (rows * vertex).maxCoeff() <= slack_tolerance) result.vertices.push_back(vertex);
    });
    if (n < 2) return result;
    for_each_choice(rows.rows(), n - 2, [&](const auto& choice) {
        if (result.direction) return;
        MatrixXd system(n - 1, n);
        system << rows(choice, Eigen::all), contact.transpose();
        const Eigen::FullPivLU<MatrixXd> lu(system);
        if (lu.rank() != n - 1) return;
        const VectorXd ray = VectorXd(lu.kernel().col(0)).normalized();
        for (const double side : {1.0, -1.0}) {
            if ((rows * (side * ray)).maxCoeff() <= slack_tolerance) result.direction = true;
        }
    });
    return result;
}

TEST(AdmissibleSet, PublicCountOfTheSixCellMesh) {
    int nontrivial = 0;
    int admissible = 0;
    for (const Pattern& pattern : small_patterns(6)) {
        if (nsma::kernel_dimension(pattern) == 0) continue;
        ++nontrivial;
        const auto set = set_of(pattern, 1);
        if (set.status == Status::nonempty) ++admissible;
        EXPECT_EQ(set.status == Status::empty, !set.reason.empty());
    }
    EXPECT_EQ(nontrivial, 209);
    EXPECT_EQ(admissible, 35);
}

TEST(AdmissibleSet, EqualsBruteForceVertexEnumeration) {
    int nonempty = 0;
    int empty = 0;
    for (int cells = 1; cells <= 6; ++cells) {
        for (const Pattern& pattern : small_patterns(cells)) {
            for (const int gap_sign : {-1, 1}) {
                const auto set = set_of(pattern, gap_sign);
                const Reduction& reduction = set.reduction;
                if (!reduction.empty_because.empty()) {
                    EXPECT_EQ(set.status, Status::empty);
                    continue;  // decided in integers: the tests of reduce()
                }
                if (reduction.variables() > 5) continue;  // too many choices of rows
                const BruteForce truth = enumerate(reduction);
                if (!truth.pointed) continue;
                SCOPED_TRACE(testing::Message() << "N = " << cells << " (" << pattern.free_steps << ", "
                                                << pattern.contact_steps << ") gap " << gap_sign);
                ASSERT_EQ(set.status, truth.vertices.empty() ? Status::empty : Status::nonempty);
                if (truth.vertices.empty()) {
                    ++empty;
                    continue;
                }
                ++nonempty;
                EXPECT_EQ(set.unbounded(), truth.direction);
                double greatest = 0;
                for (const auto& vertex : truth.vertices) {
                    greatest = std::max(greatest, vertex.squaredNorm());
                    // The least point is the projection of 0 on P: g.(v - g) >= 0 for every vertex.
                    EXPECT_GE(set.least.dot(vertex - set.least), -1e-12 * vertex.squaredNorm());
                }
                const auto interval = set.interval();
                EXPECT_EQ(interval.unbounded, truth.direction);
                EXPECT_EQ(interval.greatest.has_value(), !truth.direction);
                if (truth.direction) {
                    EXPECT_LT((cone_rows(reduction) * set.ray).maxCoeff(), slack_tolerance);
                    EXPECT_LT(std::abs(reduction.contact_row.cast<double>().dot(set.ray)), slack_tolerance);
                    EXPECT_NEAR(set.ray.norm(), 1, 1e-12);
                } else {
                    // Both solve the same small systems; only rounding differs.
                    EXPECT_NEAR(*interval.greatest, reduction.energy_factor * greatest, 1e-10 * *interval.greatest);
                }
            }
        }
    }
    EXPECT_GT(nonempty, 100);
    EXPECT_GT(empty, 20);
}

TEST(AdmissibleSet, PointsMeetEveryConditionLiterally) {
    for (int cells = 2; cells <= 8; cells += 2) {
        for (const Pattern& pattern : small_patterns(cells)) {
            for (const int gap_sign : {-1, 1}) {
                const auto kernel = exact_kernel(pattern);
                const auto set = admissible_set(reduce(conditions(kernel, gap_sign)));
                if (set.status != Status::nonempty) continue;
                std::vector<VectorXd> points = set.vertices;
                points.push_back(set.least);
                for (const auto& gamma : points) {
                    const VectorXd tip = nsma::tip_history(kernel, set.reduction.beta(gamma));
                    // Sums of at most 2N terms, each within rounding of its size.
                    const double rounding = 1e-12 * (1 + gamma.lpNorm<1>());
                    EXPECT_LE(tip.maxCoeff(), gap_sign + rounding);
                    EXPECT_NEAR(tip[0], gap_sign, rounding);
                }
                for (std::size_t i = 1; i < set.vertices.size(); ++i) {
                    EXPECT_LE(set.energy(set.vertices[i]), set.energy(set.vertices[i - 1]) * (1 + 1e-11));
                }
            }
        }
    }
}

TEST(AdmissibleSet, LeastEnergyOfEveryModeIsTheClosedForm) {
    int checked = 0;
    for (const int cells : {2, 3, 5, 6, 7, 12, 20, 24}) {
        for (int mode = 1; mode <= 4; ++mode) {
            for (const int gap_sign : {-1, 1}) {
                for (const Pattern& pattern : nsma::mode_patterns(mode, cells, gap_sign)) {
                    const auto set = set_of(pattern, gap_sign);
                    ASSERT_EQ(set.status, Status::nonempty) << set.reason;
                    const double expected = std::pow(mode * mode * pattern.period_ratio() - (2 * mode + 1), -2);
                    // The denominator loses up to two digits to cancellation in the formula itself.
                    EXPECT_NEAR(*set.interval().least, expected, 1e-12 * expected);
                    ++checked;
                }
            }
        }
    }
    EXPECT_GT(checked, 100);
}

TEST(AdmissibleSet, FirstModeIsASimplex) {
    int checked = 0;
    for (const int cells : {6, 12, 20}) {
        for (const Pattern& pattern : nsma::mode_patterns(1, cells, 1)) {
            const auto set = set_of(pattern, 1);
            const int m = nsma::kernel_dimension(pattern);
            ASSERT_TRUE(set.interval().greatest.has_value());
            EXPECT_NEAR(*set.interval().greatest, m * *set.interval().least, 1e-12 * *set.interval().greatest);
            if (m > 1) ++checked;
        }
    }
    EXPECT_GT(checked, 5);
}

TEST(AdmissibleSet, PublicIntervals) {
    const auto first = set_of({6, 16, 4}, 1).interval();
    EXPECT_NEAR(*first.least, 9, 1e-12);
    EXPECT_NEAR(*first.greatest, 36, 1e-12);
    EXPECT_EQ(nsma::kernel_dimension({6, 23, 1}), 11);
    EXPECT_NEAR(*set_of({6, 23, 1}, 1).interval().least, 12.0 / 11.0, 1e-13);
}

TEST(AdmissibleSet, ClosedGapHoldsTheModesAtTheirLimitPeriod) {
    int checked = 0;
    for (int mode = 1; mode <= 4; ++mode) {
        for (const int cells : {4, 8, 9, 16, 36}) {
            for (const Pattern& pattern : nsma::mode_patterns(mode, cells, 0)) {
                EXPECT_EQ(mode * mode * pattern.period_steps(), (2 * mode + 1) * cells);
                const auto set = set_of(pattern, 0);
                EXPECT_EQ(set.status, Status::nonempty) << set.reason;
                EXPECT_EQ(set.interval().least, 0.0);
                EXPECT_TRUE(set.interval().unbounded);
                ++checked;
            }
            // On the same branch elsewhere the only motion (m = 1) opens or presses the gap.
            for (const int gap_sign : {-1, 1}) {
                for (const Pattern& pattern : nsma::mode_patterns(mode, cells, gap_sign)) {
                    if (nsma::kernel_dimension(pattern) != 1) continue;
                    EXPECT_EQ(set_of(pattern, 0).status, Status::empty);
                }
            }
        }
    }
    EXPECT_GE(checked, 5);
}

/// No pattern of the meshes above is unbounded for an open or pressed gap (the brute force agrees),
/// so the sets here are made by hand: integer data of the same form, no rows.
Reduction by_hand(const Eigen::VectorXi& contact_row) {
    Reduction reduction;
    reduction.gap_sign = 1;
    reduction.energy_factor = 4;
    reduction.kernel_dimension = static_cast<int>(contact_row.size());
    reduction.bounded = true;
    reduction.contact_row = contact_row;
    reduction.rows.resize(0, contact_row.size());
    return reduction;
}

TEST(GeneralSet, UnboundedByHand) {
    // a - b = 1, a, b >= 0: least (1, 0), direction (1, 1).
    const auto wedge = oracle::general_set(by_hand(Eigen::VectorXi{{1, -1}}));
    ASSERT_EQ(wedge.status, Status::nonempty) << wedge.reason;
    ASSERT_TRUE(wedge.unbounded());
    EXPECT_LT((wedge.least - Eigen::Vector2d(1, 0)).norm(), 1e-14);
    EXPECT_LT((wedge.ray - Eigen::Vector2d(M_SQRT1_2, M_SQRT1_2)).norm(), 1e-14);
    EXPECT_NEAR(*wedge.interval().least, 4, 1e-14);
    EXPECT_FALSE(wedge.interval().greatest.has_value());
    // 2a = 1 with b free: a whole line.
    const auto line = oracle::general_set(by_hand(Eigen::VectorXi{{2, 0}}), {1, 0});
    ASSERT_EQ(line.status, Status::nonempty) << line.reason;
    ASSERT_TRUE(line.unbounded());
    EXPECT_NEAR(std::abs(line.ray[1]), 1, 1e-14);
    EXPECT_NEAR(*line.interval().least, 1, 1e-14);  // 4 (1/2)^2
    // The same line cut by b <= a and -b <= a is a segment that ends at (1/2, +-1/2).
    Reduction cut = by_hand(Eigen::VectorXi{{2, 0}});
    cut.rows.resize(2, 2);
    cut.rows << -1, 1, -1, -1;
    cut.row_step = {1, 2};
    const auto segment = oracle::general_set(cut, {1, 0});
    ASSERT_EQ(segment.status, Status::nonempty) << segment.reason;
    EXPECT_FALSE(segment.unbounded());
    EXPECT_NEAR(*segment.interval().greatest, 2, 1e-13);
}

TEST(GeneralSet, EmptyByRowsByHand) {
    // a + b = 1, a, b >= 0 and a + b <= 0.
    Reduction reduction = by_hand(Eigen::VectorXi{{1, 1}});
    reduction.rows = Eigen::RowVector2i(1, 1);
    reduction.row_step = {1};
    const auto set = oracle::general_set(reduction);
    EXPECT_EQ(set.status, Status::empty);
    EXPECT_FALSE(set.interval().least.has_value());
    EXPECT_FALSE(set.interval().greatest.has_value());
    EXPECT_FALSE(set.interval().unbounded);
}

TEST(AdmissibleSet, ClosedGapRaysAreOrbitsAtAnyEnergy) {
    int rays = 0;
    for (int cells = 1; cells <= 6; ++cells) {
        for (const Pattern& pattern : small_patterns(cells)) {
            const auto kernel = exact_kernel(pattern);
            const auto set = admissible_set(reduce(conditions(kernel, 0)));
            if (set.status != Status::nonempty) continue;
            ++rays;
            nsma::Bar bar;
            bar.gap = 0;
            for (const double energy : {1e-6, 1.0, 1e6}) {
                const VectorXd beta = set.reduction.beta(set.ray * std::sqrt(energy / set.energy(set.ray)));
                const auto judged = nsma::replay(nsma::make_orbit(bar, kernel, beta), energy);
                EXPECT_TRUE(judged.accepted)
                    << "N = " << cells << " (" << pattern.free_steps << ", " << pattern.contact_steps << ") energy "
                    << energy << ", worst " << judged.violations.worst();
            }
        }
    }
    EXPECT_GT(rays, 5);
}

}  // namespace
