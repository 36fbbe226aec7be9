#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <nlopt.h>

#include "../check/literal.hpp"
#include "nsma/set/objective.hpp"

/// The program of an orbit written down once more from the scheme alone, and solved by SLSQP from many starts.
namespace literal {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using nsma::Objective;

// Amounts by which the right-hand sides move.
struct Moved {
    double gap = 0, contact = 0, band = 0, energy = 0;
    std::map<int, double> flight, force;  // by step: x_n <= d + ., lambda_n <= .
};

// The program of a pattern over the amplitudes, from the scheme alone.
class Program {
public:
    Program(const Pattern& pattern, int gap_sign, Objective objective, const VectorXd& reference)
        : problem_(literal::problem(pattern, gap_sign)),
          objective_(objective),
          reference_(reference),
          m_(problem_.dimension) {
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
    [[nodiscard]] const MatrixXd& shock() const { return shock_; }
    [[nodiscard]] const VectorXd& target() const { return target_; }
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
            inequality(tips_.row(step),
                       problem_.gap_sign + moved.gap + (extra == moved.flight.end() ? 0.0 : extra->second));
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
        for (int n = problem_.pattern.free_steps; n < problem_.period; ++n)
            peak = std::max(peak, std::abs(wave(n).dot(beta)));
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
            (row.equality ? nlopt_add_equality_constraint : nlopt_add_inequality_constraint)(opt, Context::run,
                                                                                             &linear.back(), 1e-13);
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
            y += system.completeOrthogonalDecomposition().solve(
                Eigen::Map<const VectorXd>(defects.data(), system.rows()));
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

    Problem problem_;
    Objective objective_;
    VectorXd reference_;
    int m_;
    MatrixXd tips_, square_, shock_;
    VectorXd target_;
    double offset_ = 0;
};

// Every order of the values of an optimum up to five amplitudes, else its shifts among the columns and their reversals;
// then fixed mixtures of those. Signs stay with the columns.
inline std::vector<VectorXd> starts_from(const VectorXd& beta, const VectorXd& signs) {
    const VectorXd sizes = beta.cwiseProduct(signs);
    std::vector<double> order(sizes.begin(), sizes.end());
    std::vector<VectorXd> starts{beta};
    const auto keep = [&](const std::vector<double>& values) {
        const VectorXd start = Eigen::Map<const VectorXd>(values.data(), beta.size()).cwiseProduct(signs);
        const bool known = std::any_of(starts.begin(), starts.end(), [&](const VectorXd& other) {
            return (other - start).norm() < 1e-9 * beta.norm();
        });
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
        for (std::size_t i = 0; i < copies; ++i)
            mixture += (0.1 + static_cast<double>(random() >> 11) * 0x1p-53) * starts[i];
        starts.push_back(beta.norm() * mixture.normalized());
    }
    return starts;
}

}  // namespace literal
