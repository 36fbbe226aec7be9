// Slopes of whole small spectra against programs written down and solved anew: the scheme's own rows, SLSQP from every copy
// of the optimum and from elsewhere, right-hand sides moved both ways. Shares nothing with the prices but the pattern.
// NSMA_LONG_TESTS=1 in the environment takes every row of every optimum up to N = 6.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>
#include <nlopt.h>

#include "literal.hpp"

#include "nsma/program/orbit_solver.hpp"
#include "nsma/program/relaxed_solver.hpp"
#include "nsma/study/sensitivity.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using nsma::Objective;
using nsma::Parameter;
using nsma::Pattern;
using nsma::Price;

// Amounts by which the right-hand sides move.
struct Moved {
    double gap = 0, contact = 0, band = 0, energy = 0;
    std::map<int, double> flight, force;  // by step: x_n <= d + ., lambda_n <= .
};

// The program of a pattern over the amplitudes, from the scheme alone.
class Literal {
public:
    Literal(const Pattern& pattern, int gap_sign, Objective objective, const VectorXd& reference)
        : problem_(literal::problem(pattern, gap_sign)), objective_(objective), reference_(reference), m_(problem_.dimension) {
        const int window = 2 * pattern.cells;
        tips_ = MatrixXd::Zero(problem_.period + 1, m_);
        for (int n = 0; n <= problem_.period; ++n) {
            for (int k = n; k < n + window; ++k) add(tips_, n, k, -1.0);
        }
        square_ = MatrixXd::Zero(m_, m_);
        for (int k = 0; k < window; ++k) square_ += 2.0 * pattern.cells * wave(k).transpose() * wave(k);
        shock_ = MatrixXd::Zero(m_, m_);
        for (int k = 0; k < problem_.period; ++k) {
            const Eigen::RowVectorXd jump = wave(k + 1) - wave(k);
            shock_ += 2.0 * pattern.cells * jump.transpose() * jump;
        }
        target_ = VectorXd::Zero(m_);
        if (objective == Objective::nearest) {
            for (int k = 0; k < window; ++k) target_ += 2.0 * pattern.cells * reference[k] * wave(k).transpose();
            offset_ = 2.0 * pattern.cells * reference.squaredNorm();
        }
    }

    [[nodiscard]] int dimension() const { return m_; }
    [[nodiscard]] Eigen::RowVectorXd wave(int n) const {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(m_);
        const auto k = static_cast<std::size_t>(n % problem_.period);
        if (problem_.column[k] >= 0) row[problem_.column[k]] = problem_.sign[k];
        return row;
    }

    // The least objective that SLSQP finds from any of the starts, infinity where it finds no point.
    [[nodiscard]] double least(double level, const Moved& moved, const std::vector<VectorXd>& starts) const {
        const Pattern& pattern = problem_.pattern;
        const bool peak = objective_ == Objective::least_force;
        const auto n = static_cast<Eigen::Index>(m_ + (peak ? 1 : 0));
        std::vector<Row> rows;
        const double place = problem_.gap_sign + moved.gap + moved.contact;
        const auto inequality = [&](Eigen::RowVectorXd row, double limit) {
            row.conservativeResize(n);
            if (peak) row[m_] = 0;
            const double norm = std::max(row.norm(), 1e-300);
            rows.push_back({row / norm, limit / norm, false});
        };
        for (int step = 1; step < pattern.free_steps; ++step) {
            const auto extra = moved.flight.find(step);
            // Rows equal to COND2's belong to it.
            if ((tips_.row(step) - tips_.row(0)).isZero(1e-9)) continue;
            inequality(tips_.row(step), problem_.gap_sign + moved.gap + (extra == moved.flight.end() ? 0.0 : extra->second));
        }
        for (int step = pattern.free_steps; step < problem_.period; ++step) {
            const auto extra = moved.force.find(step);
            if (wave(step).isZero()) continue;  // nor has a step at which nothing arrives, whatever the motion
            inequality(-2.0 * pattern.cells * wave(step), extra == moved.force.end() ? 0.0 : extra->second);
            if (!peak) continue;
            for (const double side : {1.0, -1.0}) {
                Eigen::RowVectorXd row(n);
                row << side * 2.0 * pattern.cells * wave(step), -1.0;
                rows.push_back({row / row.norm(), 0.0, false});
            }
        }
        if (moved.band > 0) {
            inequality(tips_.row(0), place + moved.band);
            inequality(-tips_.row(0), moved.band - place);
        } else {
            Eigen::RowVectorXd row = tips_.row(0);
            row.conservativeResize(n);
            if (peak) row[m_] = 0;
            if (row.norm() > 0) rows.push_back({row / row.norm(), place / row.norm(), true});
        }
        const double energy = level + moved.energy;
        const double scale = std::sqrt(energy / square_(0, 0));
        double best = std::numeric_limits<double>::infinity();
        for (const VectorXd& start : starts) {
            const auto found = solve(n, rows, energy, scale, start);
            if (found) best = std::min(best, *found);
        }
        return best;
    }

    [[nodiscard]] double value(const VectorXd& beta) const {
        switch (objective_) {
            case Objective::least_shock: return beta.dot(shock_ * beta);
            case Objective::nearest: return beta.dot(square_ * beta) - 2 * target_.dot(beta) + offset_;
            default: break;
        }
        double peak = 0;
        for (int n = problem_.pattern.free_steps; n < problem_.period; ++n) peak = std::max(peak, std::abs(wave(n).dot(beta)));
        return 2.0 * problem_.pattern.cells * peak;
    }

private:
    struct Row {
        Eigen::RowVectorXd row;
        double limit;
        bool equality;
    };

    void add(MatrixXd& rows, int at, int k, double factor) const { rows.row(at) += factor * wave(k); }

    // SLSQP over y = (beta, peak)/scale.
    [[nodiscard]] std::optional<double> solve(Eigen::Index n, const std::vector<Row>& rows, double energy, double scale,
                                              const VectorXd& start) const {
        struct Context {
            std::function<double(const VectorXd&, VectorXd&)> call;
            static double run(unsigned size, const double* x, double* gradient, void* self) {
                VectorXd slope = VectorXd::Zero(size);
                const double value = static_cast<Context*>(self)->call(Eigen::Map<const VectorXd>(x, size), slope);
                if (gradient != nullptr) Eigen::Map<VectorXd>(gradient, size) = slope;
                return value;
            }
        };
        const double unit = std::max(value(start), 1e-3 * energy);
        Context objective{[&](const VectorXd& y, VectorXd& slope) {
            const VectorXd beta = scale * y.head(m_);
            if (objective_ == Objective::least_force) {
                slope[m_] = scale / unit;
                return scale * y[m_] / unit;
            }
            if (objective_ == Objective::least_shock) {
                slope.head(m_) = 2 * scale / unit * (shock_ * beta);
            } else {
                slope.head(m_) = 2 * scale / unit * (square_ * beta - target_);
            }
            return value(beta) / unit;
        }};
        Context sphere{[&](const VectorXd& y, VectorXd& slope) {
            const VectorXd beta = scale * y.head(m_);
            slope.head(m_) = 2 * scale / energy * (square_ * beta);
            return beta.dot(square_ * beta) / energy - 1;
        }};
        std::vector<Context> linear;
        linear.reserve(rows.size());
        nlopt_opt opt = nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(n));
        nlopt_set_min_objective(opt, Context::run, &objective);
        nlopt_add_equality_constraint(opt, Context::run, &sphere, 1e-13);
        for (const Row& row : rows) {
            linear.push_back({[&row, scale](const VectorXd& y, VectorXd& slope) {
                slope = row.row.transpose();
                return row.row.dot(y) - row.limit / scale;
            }});
            (row.equality ? nlopt_add_equality_constraint : nlopt_add_inequality_constraint)(opt, Context::run, &linear.back(), 1e-13);
        }
        nlopt_set_xtol_rel(opt, 1e-15);
        nlopt_set_ftol_rel(opt, 1e-15);
        nlopt_set_maxeval(opt, 400);
        VectorXd y(n);
        y.head(m_) = start / scale;
        if (n > m_) y[m_] = value(start) / scale;
        double at = 0;
        (void)nlopt_optimize(opt, y.data(), &at);
        nlopt_destroy(opt);
        if (!y.allFinite()) return std::nullopt;
        // SLSQP may stop short of its constraints: onto the sphere and what it holds at equality, by least change.
        for (int pass = 0; pass < 3; ++pass) {
            std::vector<Eigen::RowVectorXd> normals(1, Eigen::RowVectorXd::Zero(n));
            VectorXd slope = VectorXd::Zero(n);
            std::vector<double> defects{-sphere.call(y, slope)};
            normals[0] = slope.transpose();
            for (const Row& row : rows) {
                const double slack = row.limit / scale - row.row.dot(y);
                if (!row.equality && slack > 1e-7) continue;
                normals.push_back(row.row);
                defects.push_back(slack);
            }
            MatrixXd system(static_cast<Eigen::Index>(normals.size()), n);
            for (std::size_t i = 0; i < normals.size(); ++i) system.row(static_cast<Eigen::Index>(i)) = normals[i];
            y += system.completeOrthogonalDecomposition().solve(Eigen::Map<const VectorXd>(defects.data(), system.rows()));
        }
        VectorXd none = VectorXd::Zero(n);
        double off = std::abs(sphere.call(y, none));
        for (const Row& row : rows) {
            const double slack = row.limit / scale - row.row.dot(y);
            off = std::max(off, row.equality ? std::abs(slack) : -slack);
        }
        // Feasible to far less than a step changes the objective by.
        if (off > 1e-9) return std::nullopt;
        return value(scale * y.head(m_));
    }

    literal::Problem problem_;
    Objective objective_;
    VectorXd reference_;
    int m_;
    MatrixXd tips_, square_, shock_;
    VectorXd target_;
    double offset_ = 0;
};

// Every order of the values of an optimum up to five amplitudes, else its shifts among the columns and their reversals; then
// fixed mixtures of those. Signs stay with the columns.
std::vector<VectorXd> starts_from(const VectorXd& beta, const VectorXd& signs) {
    const VectorXd sizes = beta.cwiseProduct(signs);
    std::vector<double> order(sizes.begin(), sizes.end());
    std::vector<VectorXd> starts{beta};
    const auto keep = [&](const std::vector<double>& values) {
        const VectorXd start = Eigen::Map<const VectorXd>(values.data(), beta.size()).cwiseProduct(signs);
        const bool known = std::any_of(starts.begin(), starts.end(), [&](const VectorXd& other) { return (other - start).norm() < 1e-9 * beta.norm(); });
        if (!known) starts.push_back(start);
    };
    if (beta.size() <= 4) {
        std::sort(order.begin(), order.end());
        do keep(order);
        while (std::next_permutation(order.begin(), order.end()));
    } else {
        for (int side = 0; side < 2; ++side) {
            for (Eigen::Index shift = 0; shift < beta.size(); ++shift) {
                keep(order);
                std::rotate(order.begin(), order.begin() + 1, order.end());
            }
            std::reverse(order.begin(), order.end());
        }
    }
    std::mt19937_64 random(3);
    const std::size_t copies = starts.size();
    for (int k = 0; k < 3 && copies > 1; ++k) {
        VectorXd mixture = VectorXd::Zero(beta.size());
        for (std::size_t i = 0; i < copies; ++i) mixture += (0.1 + static_cast<double>(random() >> 11) * 0x1p-53) * starts[i];
        starts.push_back(beta.norm() * mixture.normalized());
    }
    return starts;
}

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
    int optima = 0, tied = 0, refused = 0, compared = 0, roots = 0, nowhere = 0;
    double worst = 0;
};

void compare(const nsma::OptimumRecord& record, int gap_sign, const VectorXd& reference, bool all_rows, Tally& tally) {
    ++tally.optima;
    if (record.tied > 1) ++tally.tied;
    if (!record.refusal.empty()) {
        ++tally.refused;
        return;
    }
    const Pattern& pattern = record.orbit.kernel.pattern;
    const Literal program(pattern, gap_sign, record.objective, reference);
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
    int rows = 0;
    for (const Price& price : record.prices) {
        const bool row = price.parameter == Parameter::cond1_row || price.parameter == Parameter::cond3_row;
        if (row && !all_rows && (rows++ % 3 != 0)) continue;
        // Energies move by a share of the level, lengths and forces by one of theirs.
        const double unit = price.parameter == Parameter::energy ? level : price.parameter == Parameter::cond3_row || price.parameter == Parameter::adhesion ? std::sqrt(level) : gap_sign == 0 ? std::sqrt(level) : 1.0;
        for (const double side : {1.0, -1.0}) {
            const auto& finite = side > 0 ? price.slope.right : price.slope.left;
            const auto& root = side > 0 ? price.slope.right_root : price.slope.left_root;
            if (root) ++tally.roots;
            if (!finite) {
                if (!root) ++tally.nowhere;
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
            const auto where = testing::Message() << pattern.cells << " (" << pattern.free_steps << ", " << pattern.contact_steps << ") gap " << gap_sign
                                                  << " " << nsma::name(record.objective) << " at " << level << ": " << nsma::name(price.parameter)
                                                  << " step " << (price.steps.empty() ? -1 : price.steps.front()) << (side > 0 ? " right" : " left")
                                                  << ", " << record.tied << " tied";
            EXPECT_TRUE(found) << where;
            if (!found) continue;
            const double slope = 2 * quotient[1] - quotient[0];
            // What is left of the step's square, and of the solver's rounding over the step.
            const double size = std::abs(slope) + 0.01 * (record.value + 1e-2 * level) / unit;
            const double error = std::abs(*finite - slope) / size;
            tally.worst = std::max(tally.worst, error);
            ++tally.compared;
            EXPECT_LT(error, 5e-3) << where << ": " << *finite << " against " << slope;
        }
    }
}

TEST(PriceSpectrum, EverySlopeIsThatOfTheProgramsSolvedAnew) {
    const bool longer = std::getenv("NSMA_LONG_TESTS") != nullptr;
#ifdef __SANITIZE_ADDRESS__
    const int most = longer ? 6 : 3;
#else
    const int most = longer ? 8 : 5;
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
                    const double level = gap_sign == 0 ? 1 + share : *interval.least + share * (*interval.greatest - *interval.least);
                    for (const auto objective : {Objective::least_shock, Objective::least_force, Objective::nearest}) {
                        nsma::OrbitRequest request{level, objective, {}, {}};
                        if (objective == Objective::nearest) {  // a target that tells the columns apart
                            VectorXd skew = VectorXd::LinSpaced(problem.kernel.dimension(), 0.3, 1.0);
                            skew = problem.set.reduction.beta(problem.set.reduction.gamma(skew).cwiseAbs() / problem.kernel.dimension());
                            request.reference = nsma::reference_window(nsma::make_orbit(bar, problem.kernel, skew));
                        }
                        const auto answer = solver.solve(bar, problem, request);
                        ASSERT_TRUE(answer.orbit) << answer.reason;
                        const auto record = nsma::optimum_record(*answer.orbit, gap_sign, objective, level, answer.reference);
                        compare(record, gap_sign, answer.reference, longer, tally);
                    }
                }
            }
        }
    }
    std::printf("%d optima, %d tied, %d refused; %d slopes compared, worst %.1e, %d roots, %d without a slope\n", tally.optima,
                tally.tied, tally.refused, tally.compared, tally.worst, tally.roots, tally.nowhere);
    EXPECT_GT(tally.compared, longer ? 5'000 : 200);
    EXPECT_GT(tally.tied, 10);
    EXPECT_LT(tally.refused, tally.optima / 4);
}

// Greatest energies of sets with every right-hand side moved, by trying every choice of rows that can meet in a vertex.
class Vertices {
public:
    Vertices(const Pattern& pattern, int gap_sign) : pattern_(pattern), gap_sign_(gap_sign), program_(pattern, gap_sign, Objective::least_shock, {}) {
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
                    for (std::size_t i = 0; i < normals.size(); ++i) inside = inside && normals[i].dot(x) <= limits[i] + 1e-9;
                    if (inside) best = std::max(best, 4.0 * pattern_.cells * pattern_.cells / pattern_.class_count() * x.squaredNorm());
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
    Literal program_;
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
                if (problem.verdict != nsma::Verdict::admissible || problem.kernel.dimension() < 2 || problem.kernel.dimension() > 4) continue;
                const Vertices vertices(pattern, gap_sign);
                const auto set = nsma::relaxed_set(problem.kernel, gap_sign);
                const auto record = nsma::interval_record(set);
                ASSERT_TRUE(record.greatest);
                const double here = vertices.greatest({});
                EXPECT_NEAR(*record.greatest, here, 1e-9 * here);  // of the linear solves
                const auto where = testing::Message() << cells << " (" << pattern.free_steps << ", " << pattern.contact_steps << ") gap " << gap_sign;
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
                        EXPECT_LT(error, 1e-4) << where << " " << nsma::name(price.parameter) << (side > 0 ? " right " : " left ") << *finite << " against " << slope;
                        ++compared;
                        if (price.slope.kind == nsma::Slope::Kind::one_sided) ++tied;
                    }
                }
                // Relaxed by amounts that are not small.
                for (const double amount : {0.01, 0.1, 0.3}) {
                    for (const Parameter parameter : {Parameter::band, Parameter::penetration, Parameter::adhesion}) {
                        nsma::Relaxation relaxation;
                        (parameter == Parameter::band ? relaxation.band : parameter == Parameter::penetration ? relaxation.penetration : relaxation.adhesion) = amount;
                        const auto interval = nsma::relaxed_interval(set, set.shift(relaxation));
                        Price price;
                        price.parameter = parameter;
                        const double expected = vertices.greatest(moved_by(price, pattern, amount));
                        if (interval.unbounded) continue;
                        EXPECT_NEAR(interval.greatest, expected, 1e-8 * expected) << where << " " << nsma::name(parameter) << " " << amount;
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
