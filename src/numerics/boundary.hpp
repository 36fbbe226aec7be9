#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "decompositions.hpp"
#include "program.hpp"

namespace nsma {

enum class Kind { inequality, lower, upper };
struct Row {
    Kind kind;
    Eigen::Index index;
};

/// The feasible set as rows a.x <= b, equalities apart, and the moves along its boundary.
class Boundary {
public:
    explicit Boundary(const Program& program) : program_(program), equalities_(program.equalities) {}

    [[nodiscard]] double slack(const Row& row, const Eigen::VectorXd& x) const {
        switch (row.kind) {
            case Kind::inequality:
                return program_.inequality_values[row.index] - program_.inequalities.row(row.index).dot(x);
            case Kind::lower: return x[row.index] - program_.lower[row.index];
            default: return program_.upper[row.index] - x[row.index];
        }
    }

    [[nodiscard]] std::vector<Row> active(const Eigen::VectorXd& x, double tolerance) const {
        std::vector<Row> rows;
        for_each_row([&](const Row& row) {
            if (slack(row, x) <= tolerance) rows.push_back(row);
        });
        return rows;
    }

    [[nodiscard]] Eigen::RowVectorXd normal(const Row& row) const {
        const auto n = program_.variables();
        Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(n);
        if (row.kind == Kind::inequality) {
            result = program_.inequalities.row(row.index);
        } else {
            result[row.index] = row.kind == Kind::lower ? -1.0 : 1.0;
        }
        return result;
    }

    [[nodiscard]] Eigen::MatrixXd normals(const std::vector<Row>& rows) const {
        Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), program_.variables());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            result.row(static_cast<Eigen::Index>(i)) = normal(rows[i]);
        }
        return result;
    }

    // Orthonormal basis of the directions in which the equalities and `rows` keep their values.
    [[nodiscard]] Eigen::MatrixXd directions(const std::vector<Row>& rows) const {
        const Flat flat = flat_of(rows);
        const Eigen::MatrixXd inner = null_space(flat.system, flat.system.cols());
        Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(program_.variables(), inner.cols());
        basis(flat.free, Eigen::all) = inner;
        return basis;
    }

    // Nearest point of the flat on which `rows` and the equalities hold exactly.
    [[nodiscard]] Eigen::VectorXd project(const std::vector<Row>& rows, Eigen::VectorXd x) const {
        for (const auto& row : rows) {  // bounds hold to the bit
            if (row.kind == Kind::lower) x[row.index] = program_.lower[row.index];
            if (row.kind == Kind::upper) x[row.index] = program_.upper[row.index];
        }
        const Flat flat = flat_of(rows);
        if (flat.system.rows() == 0 || flat.system.cols() == 0) return x;
        const MinimumNorm least(flat.system);
        for (int pass = 0; pass < 2; ++pass) {
            Eigen::VectorXd defect(flat.system.rows());
            defect.head(equalities_.rows()) = program_.equality_values - equalities_ * x;
            auto next = equalities_.rows();
            for (const auto& row : rows) {
                if (row.kind == Kind::inequality) defect[next++] = slack(row, x);
            }
            x(flat.free) += least.solve(defect);
        }
        return x;
    }

    // Moves x back to the sphere within x + span(basis); false where the flat misses it.
    [[nodiscard]] bool retract(const Eigen::MatrixXd& basis, Eigen::VectorXd& x) const {
        if (program_.sphere_variables == 0) return true;
        for (int pass = 0; pass < 3; ++pass) {
            const Eigen::VectorXd radial = basis * (basis.transpose() * on_sphere(x));
            const Eigen::VectorXd w = on_sphere(radial);
            const double a = w.squaredNorm();
            const double b = x.dot(w);
            const double c = program_.sphere_residual(x);
            const double discriminant = b * b - a * c;
            if (a <= 0 || discriminant < 0) return std::abs(c) <= 1e-14;
            // The root near zero of a s^2 + 2 b s + c, without cancellation.
            const double root = b + std::copysign(std::sqrt(discriminant), b);
            if (root == 0) return false;
            x -= (c / root) * radial;
            if (std::abs(c) <= 1e-15) break;
        }
        return std::abs(program_.sphere_residual(x)) <= 1e-13;
    }

    // x with everything off the sphere set to zero: the gradient of the sphere is twice this.
    [[nodiscard]] Eigen::VectorXd on_sphere(Eigen::VectorXd x) const {
        x.tail(x.size() - program_.sphere_variables).setZero();
        return x;
    }

    // Largest t <= 1 for which no row is crossed along x + t direction; blocking row if t < 1.
    double step_to_boundary(const Eigen::VectorXd& x, const Eigen::VectorXd& direction, double tolerance,
                            std::vector<Row>& blocking) const {
        double step = 1.0;
        Row first{Kind::inequality, -1};
        for_each_row([&](const Row& row) {
            const double rate = row.kind == Kind::inequality
                                    ? program_.inequalities.row(row.index).dot(direction)
                                    : (row.kind == Kind::lower ? -1.0 : 1.0) * direction[row.index];
            if (rate <= tolerance) return;
            const double t = std::max(slack(row, x), 0.0) / rate;
            if (t < step) {
                step = t;
                first = row;
            }
        });
        if (first.index >= 0) blocking.push_back(first);
        return step;
    }

private:
    // Equalities above the inequalities among `rows`, on the unknowns that no bound among them holds.
    struct Flat {
        std::vector<Eigen::Index> free;
        Eigen::MatrixXd system;
    };
    [[nodiscard]] Flat flat_of(const std::vector<Row>& rows) const {
        std::vector<char> held(static_cast<std::size_t>(program_.variables()), 0);
        std::vector<Eigen::Index> chosen;
        for (const auto& row : rows) {
            if (row.kind == Kind::inequality) {
                chosen.push_back(row.index);
            } else {
                held[static_cast<std::size_t>(row.index)] = 1;
            }
        }
        Flat flat;
        for (Eigen::Index j = 0; j < program_.variables(); ++j) {
            if (held[static_cast<std::size_t>(j)] == 0) flat.free.push_back(j);
        }
        const auto count = static_cast<Eigen::Index>(flat.free.size());
        flat.system.resize(equalities_.rows() + static_cast<Eigen::Index>(chosen.size()), count);
        flat.system.topRows(equalities_.rows()) = equalities_(Eigen::all, flat.free);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const Eigen::RowVectorXd row = program_.inequalities.row(chosen[i]);
            flat.system.row(equalities_.rows() + static_cast<Eigen::Index>(i)) = row(flat.free);
        }
        return flat;
    }

    template <typename Visit>
    void for_each_row(const Visit& visit) const {
        for (Eigen::Index i = 0; i < program_.inequalities.rows(); ++i) visit({Kind::inequality, i});
        for (Eigen::Index j = 0; j < program_.variables(); ++j) {
            if (program_.lower[j] > -no_bound) visit({Kind::lower, j});
            if (program_.upper[j] < no_bound) visit({Kind::upper, j});
        }
    }

    const Program& program_;
    Eigen::MatrixXd equalities_;
};

}  // namespace nsma
