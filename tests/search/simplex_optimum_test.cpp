// Best points in closed form against a search that looks everywhere.
#include "search/simplex_optimum.hpp"

#include <random>

#include <gtest/gtest.h>

#include "simplex_reference.hpp"
#include "nsma/orbit/kernel.hpp"
#include "nsma/set/admissible_set.hpp"
#include "search/orbit_program.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using nsma::SimplexLevel;

class Draw {
public:
    double operator()(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 random_{20'161'112};
};

// Sum of squared differences of neighbours, zero before the first and after the last, with a link of weight `closure`
// between them.
MatrixXd shock_matrix(int n, double closure) {
    MatrixXd a = 2 * MatrixXd::Identity(n, n);
    for (int j = 0; j + 1 < n; ++j) a(j, j + 1) = a(j + 1, j) = -1;
    a(0, n - 1) -= closure;
    a(n - 1, 0) -= closure;
    return a;
}

// |x|^2 between that of the centre and of a vertex, often close to one of them.
double square_in(Draw& draw, int n, double s) {
    const double share = std::pow(draw(1e-6, 1), draw(0, 1) < 0.5 ? 1 : 4);
    return s * s * (1.0 / n + (1 - 1.0 / n) * (draw(0, 1) < 0.8 ? share : 1 - 0.01 * share));
}

void expect_on_level(const VectorXd& x, const SimplexLevel& level) {
    ASSERT_EQ(x.size(), level.size);
    EXPECT_GE(x.minCoeff(), 0.0);
    if (level.sum != 0) {
        EXPECT_NEAR(x.sum(), level.sum, 1e-14 * level.sum * std::sqrt(level.size));  // rounding of a sum
    }
    EXPECT_NEAR(x.squaredNorm(), level.square, 1e-14 * level.square * static_cast<double>(level.size));
}

#ifdef __SANITIZE_ADDRESS__
constexpr int programs = 60;
#else
constexpr int programs = 600;
#endif
// Of the search: its roots to 1e-13 and what it takes as nonnegative.
constexpr double search_tolerance = 1e-9;

TEST(SimplexOptimum, NoPointIsSmootherThanTheHump) {
    Draw draw;
    for (int i = 0; i < programs; ++i) {
        const int n = 2 + i % 5;
        const double closure = i % 3 == 0 ? 0.0 : draw(-1, 1);
        const double s = draw(0.1, 3);
        const SimplexLevel level{n, s, square_in(draw, n, s)};
        SCOPED_TRACE(testing::Message() << n << " closure " << closure << " sum " << s << " square " << level.square);
        const VectorXd x = nsma::smoothest_point(level, closure);
        expect_on_level(x, level);
        const MatrixXd a = shock_matrix(n, closure);
        const auto best = reference::least(a, VectorXd::Zero(n), s, level.square);
        ASSERT_FALSE(best.points.empty());
        EXPECT_NEAR(x.dot(a * x), best.value, search_tolerance * best.value);
    }
}

TEST(SimplexOptimum, OfAConeTheLeastEigenvectorIsTheSmoothest) {
    Draw draw;
    for (int i = 0; i < programs / 4; ++i) {
        const int n = 1 + i % 6;
        const double closure = n == 1 || i % 3 == 0 ? 0.0 : draw(-1, 1);
        const SimplexLevel level{n, 0.0, draw(1e-3, 1e3)};
        const VectorXd x = nsma::smoothest_point(level, closure);
        expect_on_level(x, level);
        const MatrixXd a = shock_matrix(n, closure);
        const auto best = reference::least(a, VectorXd::Zero(n), 0.0, level.square);
        EXPECT_NEAR(x.dot(a * x), best.value, search_tolerance * std::abs(best.value)) << n << " closure " << closure;
    }
}

TEST(SimplexOptimum, NoPointIsNearerToTheTarget) {
    Draw draw;
    for (int i = 0; i < programs; ++i) {
        const int n = 2 + i % 5;
        const double s = i % 4 == 0 ? 0.0 : draw(0.1, 3);
        const SimplexLevel level{n, s, s == 0 ? draw(1e-3, 1e3) : square_in(draw, n, s)};
        VectorXd target(n);
        for (auto& value : target) value = draw(-1, i % 7 == 0 ? -0.1 : 1);
        if (i % 5 == 0) target[0] = target[n - 1];  // ties
        if (i % 25 == 0) target.setConstant(0.7);
        SCOPED_TRACE(testing::Message() << n << " sum " << s << " square " << level.square << " target "
                                        << target.transpose());
        const VectorXd x = nsma::nearest_point(level, target);
        expect_on_level(x, level);
        const auto best = reference::least(MatrixXd::Zero(n, n), -0.5 * target, s, level.square);
        ASSERT_FALSE(best.points.empty());
        EXPECT_NEAR(-target.dot(x), best.value, search_tolerance * (1 + std::abs(best.value)));
    }
}

TEST(SimplexOptimum, NoPointHasALowerPeak) {
    Draw draw;
    for (int i = 0; i < programs / 2; ++i) {
        const int n = 2 + i % 5;
        const double s = i % 5 == 0 ? 0.0 : draw(0.1, 3);
        const SimplexLevel level{n, s, s == 0 ? draw(1e-3, 1e3) : square_in(draw, n, s)};
        const VectorXd x = nsma::least_peak_point(level);
        expect_on_level(x, level);
        EXPECT_NEAR(x.maxCoeff(), reference::least_peak(n, s, level.square), search_tolerance * x.maxCoeff())
            << n << " sum " << s << " square " << level.square;
    }
}

TEST(SimplexOptimum, EndsOfTheLevelAreTheCentreAndAVertex) {
    for (const int n : {1, 2, 3, 8}) {
        const SimplexLevel low{n, 2.0, 4.0 / n}, high{n, 2.0, 4.0};
        const VectorXd target = VectorXd::LinSpaced(n, 0, 1);
        for (const VectorXd& x :
             {nsma::smoothest_point(low, 0.0), nsma::nearest_point(low, target), nsma::least_peak_point(low)}) {
            EXPECT_LT((x.array() - 2.0 / n).abs().maxCoeff(), 1e-7);  // the root of rounding: the sphere touches there
        }
        for (const VectorXd& x :
             {nsma::smoothest_point(high, 0.0), nsma::nearest_point(high, target), nsma::least_peak_point(high)}) {
            EXPECT_NEAR(x.maxCoeff(), 2.0, 1e-12);
        }
    }
}

// Too many for the search: the first-order conditions, with the multipliers of sum and sphere by least squares.
TEST(SimplexOptimum, ManyVariablesMeetTheFirstOrderConditions) {
    const int n = 400;
    for (const double closure : {0.0, 0.6}) {
        const MatrixXd a = shock_matrix(n, closure);
        for (int k = 1; k <= 40; ++k) {
            const SimplexLevel level{n, 1.0, std::pow(400.0, -1 + k / 41.0)};
            const VectorXd x = nsma::smoothest_point(level, closure);
            expect_on_level(x, level);
            std::vector<Eigen::Index> support;
            for (Eigen::Index j = 0; j < n; ++j) {
                if (x[j] > 0) support.push_back(j);
            }
            MatrixXd normals(n, 2);
            normals << x, VectorXd::Ones(n);
            const VectorXd gradient = a * x;
            const MatrixXd on = normals(support, Eigen::all);
            const VectorXd multipliers = on.colPivHouseholderQr().solve(gradient(support));
            const VectorXd rest = gradient - normals * multipliers;
            // Rounding of the root, and what the two normals, nearly one near the centre, make of it.
            const double tolerance = 1e-8 * gradient.norm();
            EXPECT_LT(rest(support).cwiseAbs().maxCoeff(), tolerance) << "square " << level.square;
            EXPECT_GT(rest.minCoeff(), -tolerance) << "square " << level.square;  // pushing back where x = 0
        }
    }
}

// The Hessian of the program, from the waves, is that of neighbours in a row with one closing link.
TEST(SimplexOptimum, TheShockOfEverySimplexIsThatOfNeighbours) {
    int closed = 0, open = 0;
    for (int cells = 1; cells <= 8; ++cells) {
        for (int period = 2; period <= 4 * cells; ++period) {
            for (int free = 1; free < period; ++free) {
                for (const int gap_sign : {-1, 0, 1}) {
                    const auto kernel = nsma::exact_kernel({cells, free, period - free});
                    const auto set = nsma::admissible_set(nsma::reduce(nsma::conditions(kernel, gap_sign)));
                    if (set.status != nsma::AdmissibleSet::Status::nonempty ||
                        set.shape != nsma::AdmissibleSet::Shape::simplex)
                        continue;
                    const int n = set.reduction.variables();
                    MatrixXd shock(n, n);
                    const auto value = [&](const VectorXd& gamma) {
                        return nsma::objective_of_waves(kernel, nsma::Objective::least_shock,
                                                        set.reduction.beta(gamma));
                    };
                    for (int i = 0; i < n; ++i) {
                        for (int j = 0; j < n; ++j) {
                            const VectorXd e = VectorXd::Unit(n, i), f = VectorXd::Unit(n, j);
                            shock(i, j) = 0.25 * (value(e + f) - value(e - f));  // polarisation
                        }
                    }
                    const double closure = nsma::shock_closure(kernel, set.reduction);
                    MatrixXd expected = n == 1 ? MatrixXd::Constant(1, 1, 2 - 2 * closure) : shock_matrix(n, closure);
                    expected *= 2.0 * cells * (period / kernel.classes);
                    EXPECT_LT((shock - expected).cwiseAbs().maxCoeff(), 1e-10 * (1 + expected.cwiseAbs().maxCoeff()))
                        << cells << " (" << free << ", " << period - free << ") gap " << gap_sign;
                    ++(closure == 0 ? open : closed);
                }
            }
        }
    }
    EXPECT_GT(closed, 20);
    EXPECT_GT(open, 100);
}

}  // namespace
