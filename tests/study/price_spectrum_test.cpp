// Slopes of whole small spectra against programs written down and solved anew: the scheme's own rows, SLSQP from every
// copy of the optimum and from elsewhere, right-hand sides moved both ways. Shares nothing with the prices but the
// pattern. NSMA_LONG_TESTS=1 in the environment takes every optimum up to N = 8.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "../search/literal_program.hpp"

#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "price/relaxed_solver.hpp"
#include "nsma/study/sensitivity/sensitivity.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using literal::Moved;
using literal::starts_from;
using nsma::Objective;
using nsma::Parameter;
using nsma::Pattern;
using nsma::Price;

Moved moved_by(const Price& price, const Pattern& pattern, double t) {
    Moved moved;
    switch (price.parameter) {
        case Parameter::gap: moved.gap = t; break;
        case Parameter::contact: moved.contact = t; break;
        case Parameter::band: moved.band = t; break;
        case Parameter::energy: moved.energy = t; break;
        case Parameter::penetration:
            for (int n = 1; n < pattern.free_steps; ++n) moved.flight[n] = t;
            break;
        case Parameter::adhesion:
            for (int n = pattern.free_steps; n < pattern.period_steps(); ++n) moved.force[n] = t;
            break;
        case Parameter::cond1_row:
            for (const int n : price.steps) moved.flight[n] = t;
            break;
        case Parameter::cond3_row:
            for (const int n : price.steps) moved.force[n] = t;
            break;
    }
    return moved;
}

struct Tally {
    int optima = 0, tied = 0, compared = 0, roots = 0;
    double worst = 0;
};

void compare(const nsma::OptimumRecord& record, int gap_sign, const VectorXd& reference, Tally& tally) {
    ++tally.optima;
    if (record.tied > 1) ++tally.tied;
    ASSERT_TRUE(record.refusal.empty()) << record.refusal;
    const Pattern& pattern = record.orbit.kernel.pattern;
    const literal::Program program(pattern, gap_sign, record.objective, reference);
    VectorXd signs = VectorXd::Ones(program.dimension());
    for (int n = pattern.free_steps; n < pattern.period_steps(); ++n) {
        for (int j = 0; j < signs.size(); ++j) {
            if (program.wave(n)[j] != 0) signs[j] = program.wave(n)[j];
        }
    }
    const auto starts = starts_from(record.orbit.beta, signs);
    const double level = *record.level;
    const double here = program.least(level, {}, starts);
    ASSERT_NEAR(here, record.value, 1e-7 * (record.value + 1e-3 * level)) << "the optimum itself";
    for (const Price& price : record.prices) {
        // Energies move by a share of the level, lengths and forces by one of theirs.
        const double unit = price.parameter == Parameter::energy ? level
                            : price.parameter == Parameter::cond3_row || price.parameter == Parameter::adhesion
                                ? std::sqrt(level)
                            : gap_sign == 0 ? std::sqrt(level)
                                            : 1.0;
        for (const double side : {1.0, -1.0}) {
            const auto& finite = side > 0 ? price.slope.right : price.slope.left;
            const auto& root = side > 0 ? price.slope.right_root : price.slope.left_root;
            if (root) ++tally.roots;
            if (!finite) {
                // A band has no negative width, and no other condition has a side without a value.
                if (!root) {
                    EXPECT_TRUE(price.parameter == Parameter::band && side < 0) << nsma::name(price.parameter);
                }
                continue;
            }
            const double h = 2e-4 * unit;
            double quotient[2];
            bool found = true;
            for (int k = 0; k < 2; ++k) {
                const double t = side * h / (k + 1);
                const double there = program.least(level, moved_by(price, pattern, t), starts);
                found = found && std::isfinite(there);
                quotient[k] = (there - here) / t;
            }
            const auto where = testing::Message()
                               << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps
                               << ") gap " << gap_sign << " " << nsma::name(record.objective) << " at " << level << ": "
                               << nsma::name(price.parameter) << " step "
                               << (price.steps.empty() ? -1 : price.steps.front()) << (side > 0 ? " right" : " left")
                               << ", " << record.tied << " tied";
            EXPECT_TRUE(found) << where;
            if (!found) continue;
            const double slope = 2 * quotient[1] - quotient[0];
            // What is left of the step's square, and of the solver's rounding over the step.
            const double size = std::abs(slope) + 0.01 * (record.value + 1e-2 * level) / unit;
            const double error = std::abs(*finite - slope) / size;
            tally.worst = std::max(tally.worst, error);
            ++tally.compared;
            EXPECT_LT(error, 1e-3) << where << ": " << *finite << " against " << slope;
        }
    }
}

TEST(PriceSpectrum, EverySlopeIsThatOfTheProgramsSolvedAnew) {
    const bool longer = std::getenv("NSMA_LONG_TESTS") != nullptr;
#ifdef __SANITIZE_ADDRESS__
    const int most = longer ? 6 : 4;
#else
    const int most = longer ? 8 : 6;
#endif
    Tally tally;
    nsma::OrbitSolver solver;
    for (int cells = 2; cells <= most; ++cells) {
        for (const Pattern& pattern : nsma::patterns_in(cells, {2, 4 * cells, 1, nsma::max_period_steps})) {
            for (const int gap_sign : {1, -1, 0}) {
                const auto problem = nsma::pattern_problem(pattern, gap_sign, {.prove = false});
                if (problem.kind != nsma::PatternKind::contact || problem.kernel.dimension() < 2) continue;
                nsma::Bar bar;
                bar.gap = gap_sign;
                const auto& interval = problem.interval;
                for (const double share : {0.13, 0.4, 0.5, 0.75}) {
                    const double level =
                        gap_sign == 0 ? 1 + share : *interval.least + share * (*interval.greatest - *interval.least);
                    for (const auto objective : {Objective::least_shock, Objective::least_force, Objective::nearest}) {
                        nsma::OrbitRequest request{level, objective, {}, {}};
                        if (objective == Objective::nearest) {  // a target that tells the columns apart
                            VectorXd skew = VectorXd::LinSpaced(problem.kernel.dimension(), 0.3, 1.0);
                            skew = problem.set.reduction.beta(problem.set.reduction.gamma(skew).cwiseAbs() /
                                                              problem.kernel.dimension());
                            request.reference = nsma::reference_window(nsma::make_orbit(bar, problem.kernel, skew));
                        }
                        const auto answer = solver.solve(bar, problem, request);
                        ASSERT_TRUE(answer.orbit) << answer.reason;
                        const auto record =
                            nsma::optimum_record(*answer.orbit, gap_sign, objective, level, answer.reference);
                        compare(record, gap_sign, answer.reference, tally);
                    }
                }
            }
        }
    }
    std::printf("%d optima, %d tied; %d slopes compared, worst %.1e, %d roots\n", tally.optima, tally.tied,
                tally.compared, tally.worst, tally.roots);
    EXPECT_GT(tally.compared, longer ? 5'000 : 200);
    EXPECT_GT(tally.tied, 10);
}

// Greatest energies of sets with every right-hand side moved, by trying every choice of rows that can meet in a vertex.
class Vertices {
public:
    Vertices(const Pattern& pattern, int gap_sign)
        : pattern_(pattern), gap_sign_(gap_sign), program_(pattern, gap_sign, Objective::least_shock, {}) {
        const int m = program_.dimension();
        tip_ = Eigen::RowVectorXd::Zero(m);
        for (int k = 0; k < 2 * pattern.cells; ++k) tip_ -= program_.wave(k);
        Eigen::RowVectorXd rise = Eigen::RowVectorXd::Zero(m);
        for (int n = 0; n + 1 < pattern.free_steps; ++n) {
            rise += 2 * program_.wave(n);
            if (!rise.isZero()) add(tip_ + rise, n + 1, true);
        }
        for (int n = pattern.free_steps; n < pattern.period_steps(); ++n) {
            if (!program_.wave(n).isZero()) add(-2.0 * pattern.cells * program_.wave(n), n, false);
        }
    }
    [[nodiscard]] std::size_t rows() const { return rows_.size(); }

    [[nodiscard]] double greatest(const Moved& moved) const {
        const int m = program_.dimension();
        const double place = gap_sign_ + moved.gap + moved.contact;
        std::vector<Eigen::RowVectorXd> normals;
        std::vector<double> limits;
        for (const auto& [row, steps, flight] : rows_) {
            const auto& extra = flight ? moved.flight : moved.force;
            double allowed = std::numeric_limits<double>::infinity();
            for (const int n : steps) {
                const auto found = extra.find(n);
                allowed = std::min(allowed, found == extra.end() ? 0.0 : found->second);
            }
            normals.push_back(row);
            limits.push_back((flight ? gap_sign_ + moved.gap : 0.0) + allowed);
        }
        std::vector<std::pair<Eigen::RowVectorXd, double>> ends{{tip_, place}};
        if (moved.band > 0) {
            normals.push_back(tip_);
            limits.push_back(place + moved.band);
            normals.push_back(-tip_);
            limits.push_back(moved.band - place);
            ends = {{tip_, place + moved.band}, {tip_, place - moved.band}};
        }
        double best = -1;
        std::vector<std::size_t> chosen;
        const std::function<void(std::size_t)> choose = [&](std::size_t from) {
            if (static_cast<int>(chosen.size()) == m - 1) {
                for (const auto& [row, limit] : ends) {
                    MatrixXd system(m, m);
                    VectorXd target(m);
                    system.row(0) = row;
                    target[0] = limit;
                    for (int i = 1; i < m; ++i) {
                        system.row(i) = normals[chosen[static_cast<std::size_t>(i) - 1]];
                        target[i] = limits[chosen[static_cast<std::size_t>(i) - 1]];
                    }
                    const Eigen::FullPivLU<MatrixXd> lu(system);
                    if (lu.rank() < m) continue;
                    const VectorXd x = lu.solve(target);
                    bool inside = true;
                    for (std::size_t i = 0; i < normals.size(); ++i)
                        inside = inside && normals[i].dot(x) <= limits[i] + 1e-9;
                    if (inside)
                        best = std::max(
                            best, 4.0 * pattern_.cells * pattern_.cells / pattern_.class_count() * x.squaredNorm());
                }
                return;
            }
            for (std::size_t i = from; i < normals.size(); ++i) {
                chosen.push_back(i);
                choose(i + 1);
                chosen.pop_back();
            }
        };
        choose(0);
        return best;
    }

private:
    struct Row {
        Eigen::RowVectorXd row;
        std::vector<int> steps;
        bool flight;
    };
    void add(const Eigen::RowVectorXd& row, int step, bool flight) {
        for (Row& known : rows_) {
            if (known.flight == flight && (known.row - row).isZero(1e-12)) {
                known.steps.push_back(step);
                return;
            }
        }
        rows_.push_back({row, {step}, flight});
    }
    Pattern pattern_;
    int gap_sign_;
    literal::Program program_;
    Eigen::RowVectorXd tip_;
    std::vector<Row> rows_;
};

TEST(PriceSpectrum, GreatestEnergiesMoveAsTheirVerticesDo) {
    int compared = 0, tied = 0;
    double worst = 0;
    for (int cells = 1; cells <= 4; ++cells) {
        for (const Pattern& pattern : nsma::patterns_in(cells, {2, 4 * cells, 1, nsma::max_period_steps})) {
            for (const int gap_sign : {1, -1}) {
                const auto problem = nsma::pattern_problem(pattern, gap_sign, {.prove = false});
                if (problem.verdict != nsma::Verdict::admissible || problem.kernel.dimension() < 2 ||
                    problem.kernel.dimension() > 4)
                    continue;
                const Vertices vertices(pattern, gap_sign);
                const auto set = nsma::relaxed_set(problem.kernel, gap_sign);
                const auto record = nsma::interval_record(set);
                ASSERT_TRUE(record.greatest);
                const double here = vertices.greatest({});
                EXPECT_NEAR(*record.greatest, here, 1e-9 * here);  // of the linear solves
                const auto where = testing::Message() << cells << " (" << pattern.free_steps << ", "
                                                      << pattern.contact_steps << ") gap " << gap_sign;
                for (const Price& price : record.greatest_prices) {
                    for (const double side : {1.0, -1.0}) {
                        const auto& finite = side > 0 ? price.slope.right : price.slope.left;
                        if (!finite) continue;
                        double quotient[2];
                        for (int k = 0; k < 2; ++k) {
                            const double t = side * 1e-4 / (k + 1);
                            quotient[k] = (vertices.greatest(moved_by(price, pattern, t)) - here) / t;
                        }
                        const double slope = 2 * quotient[1] - quotient[0];
                        const double error = std::abs(*finite - slope) / (std::abs(slope) + 0.01 * here);
                        worst = std::max(worst, error);
                        EXPECT_LT(error, 1e-4) << where << " " << nsma::name(price.parameter)
                                               << (side > 0 ? " right " : " left ") << *finite << " against " << slope;
                        ++compared;
                        if (price.slope.kind == nsma::Slope::Kind::one_sided) ++tied;
                    }
                }
                // Relaxed by amounts that are not small.
                for (const double amount : {0.01, 0.1, 0.3}) {
                    for (const Parameter parameter : {Parameter::band, Parameter::penetration, Parameter::adhesion}) {
                        nsma::Relaxation relaxation;
                        (parameter == Parameter::band          ? relaxation.band
                         : parameter == Parameter::penetration ? relaxation.penetration
                                                               : relaxation.adhesion) = amount;
                        const auto interval = nsma::relaxed_interval(set, set.shift(relaxation));
                        Price price;
                        price.parameter = parameter;
                        const double expected = vertices.greatest(moved_by(price, pattern, amount));
                        if (interval.unbounded) continue;
                        EXPECT_NEAR(interval.greatest, expected, 1e-8 * expected)
                            << where << " " << nsma::name(parameter) << " " << amount;
                        ++compared;
                    }
                }
            }
        }
    }
    std::printf("%d slopes and relaxed energies compared, %d of ties; worst slope %.1e\n", compared, tied, worst);
    EXPECT_GT(compared, 300);
    EXPECT_GT(tied, 30);
}

}  // namespace
