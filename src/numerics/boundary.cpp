#include "boundary.hpp"

#include <algorithm>
#include <cmath>

#include "decompositions.hpp"

namespace nsma {

template <typename Visit>
void Boundary::for_each_row(const Visit& visit) const {
    for (Eigen::Index i = 0; i < program_.inequalities.rows(); ++i) visit({Row::Kind::inequality, i});
    for (Eigen::Index j = 0; j < program_.variables(); ++j) {
        if (program_.lower[j] > -no_bound) visit({Row::Kind::lower, j});
        if (program_.upper[j] < no_bound) visit({Row::Kind::upper, j});
    }
}

double Boundary::along(const Row& row, const Eigen::VectorXd& direction) const {
    if (row.kind == Row::Kind::inequality) return program_.inequalities.row(row.index).dot(direction);
    return row.kind == Row::Kind::lower ? -direction[row.index] : direction[row.index];
}

double Boundary::slack(const Row& row, const Eigen::VectorXd& x) const {
    switch (row.kind) {
        case Row::Kind::inequality: return program_.inequality_values[row.index] - along(row, x);
        case Row::Kind::lower: return x[row.index] - program_.lower[row.index];
        default: return program_.upper[row.index] - x[row.index];
    }
}

std::vector<Row> Boundary::active(const Eigen::VectorXd& x, double tolerance) const {
    std::vector<Row> rows;
    for_each_row([&](const Row& row) {
        if (slack(row, x) <= tolerance) rows.push_back(row);
    });
    return rows;
}

Eigen::MatrixXd Boundary::normals(const std::vector<Row>& rows) const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), program_.variables());
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
        const Row& row = rows[static_cast<std::size_t>(i)];
        if (row.kind == Row::Kind::inequality) {
            result.row(i) = program_.inequalities.row(row.index);
        } else {
            result(i, row.index) = row.kind == Row::Kind::lower ? -1.0 : 1.0;
        }
    }
    return result;
}

Boundary::Flat Boundary::flat_of(const std::vector<Row>& rows) const {
    std::vector<char> held(static_cast<std::size_t>(program_.variables()), 0);
    std::vector<Row> inequalities;
    for (const auto& row : rows) {
        if (row.kind == Row::Kind::inequality) {
            inequalities.push_back(row);
        } else {
            held[static_cast<std::size_t>(row.index)] = 1;
        }
    }
    Flat flat;
    for (Eigen::Index j = 0; j < program_.variables(); ++j) {
        if (held[static_cast<std::size_t>(j)] == 0) flat.free.push_back(j);
    }
    const Eigen::MatrixXd below = normals(inequalities);
    flat.system.resize(equalities_.rows() + below.rows(), static_cast<Eigen::Index>(flat.free.size()));
    flat.system.topRows(equalities_.rows()) = equalities_(Eigen::all, flat.free);
    flat.system.bottomRows(below.rows()) = below(Eigen::all, flat.free);
    return flat;
}

Eigen::MatrixXd Boundary::directions(const std::vector<Row>& rows) const {
    const Flat flat = flat_of(rows);
    const Eigen::MatrixXd inner = null_space(flat.system, flat.system.cols());
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(program_.variables(), inner.cols());
    basis(flat.free, Eigen::all) = inner;
    return basis;
}

Eigen::VectorXd Boundary::project(const std::vector<Row>& rows, Eigen::VectorXd x) const {
    for (const auto& row : rows) {  // bounds hold to the bit
        if (row.kind == Row::Kind::lower) x[row.index] = program_.lower[row.index];
        if (row.kind == Row::Kind::upper) x[row.index] = program_.upper[row.index];
    }
    const Flat flat = flat_of(rows);
    if (flat.system.rows() == 0 || flat.system.cols() == 0) return x;
    const MinimumNorm least(flat.system);
    for (int pass = 0; pass < 2; ++pass) {
        Eigen::VectorXd defect(flat.system.rows());
        defect.head(equalities_.rows()) = program_.equality_values - equalities_ * x;
        auto next = equalities_.rows();
        for (const auto& row : rows) {
            if (row.kind == Row::Kind::inequality) defect[next++] = slack(row, x);
        }
        x(flat.free) += least.solve(defect);
    }
    return x;
}

bool Boundary::retract(const Eigen::MatrixXd& basis, Eigen::VectorXd& x) const {
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

Eigen::VectorXd Boundary::on_sphere(Eigen::VectorXd x) const {
    x.tail(x.size() - program_.sphere_variables).setZero();
    return x;
}

double Boundary::step_to_boundary(const Eigen::VectorXd& x, const Eigen::VectorXd& direction, double tolerance,
                                  std::vector<Row>& blocking) const {
    double step = 1.0;
    Row first{Row::Kind::inequality, -1};
    for_each_row([&](const Row& row) {
        const double rate = along(row, direction);
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

}  // namespace nsma
