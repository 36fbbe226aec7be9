#include "nsma/program/lifted_program.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace nsma {

Eigen::VectorXd LiftedProgram::point(const Eigen::VectorXd& condensed) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(program.variables());
    x.head(condensed_variables) = condensed;
    // The ties come last and in order, so each gives the next unknown.
    const Eigen::Index count = program.variables() - condensed_variables;
    const Eigen::Index first = program.equalities.rows() - count;
    for (Eigen::Index i = 0; i < count; ++i) x[condensed_variables + i] = -program.equalities.row(first + i).dot(x);
    return x;
}

LiftedProgram lifted_program(const OrbitProgram& condensed, const Reduction& reduction, const Kernel& kernel) {
    const Program& from = condensed.program;
    const Eigen::Index count = reduction.rows.rows();
    if (from.inequalities.rows() < count || condensed.orbit_variables != reduction.variables()) {
        throw std::invalid_argument("condensed: expected the program of this reduction, got one with " +
                                    std::to_string(from.inequalities.rows()) + " rows");
    }
    LiftedProgram lifted;
    lifted.condensed_variables = from.variables();
    Program& program = lifted.program;
    const Eigen::Index variables = from.variables() + count;
    std::vector<int> variable_of(static_cast<std::size_t>(reduction.kernel_dimension), -1);
    for (int j = 0; j < reduction.variables(); ++j) {
        variable_of[static_cast<std::size_t>(reduction.column[static_cast<std::size_t>(j)])] = j;
    }

    using Triplet = Eigen::Triplet<double>;
    const auto copy = [](std::vector<Triplet>& entries, const SparseRows& rows, Eigen::Index begin, Eigen::Index to) {
        for (Eigen::Index i = begin; i < rows.rows(); ++i) {
            for (SparseRows::InnerIterator entry(rows, i); entry; ++entry) {
                entries.emplace_back(static_cast<int>(to + i - begin), static_cast<int>(entry.col()), entry.value());
            }
        }
    };
    std::vector<Triplet> ties;
    copy(ties, from.equalities, 0, 0);
    int step = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
        const int row = static_cast<int>(from.equalities.rows() + i);
        const int unknown = static_cast<int>(from.variables() + i);
        for (const int end = reduction.row_step[static_cast<std::size_t>(i)]; step < end; ++step) {
            const int column = kernel.column(step);
            const int j = column < 0 ? -1 : variable_of[static_cast<std::size_t>(column)];
            if (j < 0) continue;
            ties.emplace_back(row, j, -1.0 * reduction.flip[static_cast<std::size_t>(j)] * kernel.sign[static_cast<std::size_t>(step)]);
        }
        if (i > 0) ties.emplace_back(row, unknown - 1, -1.0);
        ties.emplace_back(row, unknown, 1.0);
    }
    program.equalities.resize(from.equalities.rows() + count, variables);
    program.equalities.setFromTriplets(ties.begin(), ties.end());
    program.equality_values = Eigen::VectorXd::Zero(program.equalities.rows());
    program.equality_values.head(from.equality_values.size()) = from.equality_values;

    std::vector<Triplet> others;
    copy(others, from.inequalities, count, 0);
    program.inequalities.resize(from.inequalities.rows() - count, variables);
    program.inequalities.setFromTriplets(others.begin(), others.end());
    program.inequality_values = from.inequality_values.tail(from.inequality_values.size() - count);

    std::vector<Triplet> hessian;
    for (Eigen::Index j = 0; j < from.hessian.outerSize(); ++j) {
        for (Eigen::SparseMatrix<double>::InnerIterator entry(from.hessian, j); entry; ++entry) {
            hessian.emplace_back(static_cast<int>(entry.row()), static_cast<int>(entry.col()), entry.value());
        }
    }
    program.hessian.resize(variables, variables);
    program.hessian.setFromTriplets(hessian.begin(), hessian.end());
    program.gradient = Eigen::VectorXd::Zero(variables);
    program.gradient.head(from.variables()) = from.gradient;
    program.constant = from.constant;
    program.lower = Eigen::VectorXd::Constant(variables, -no_bound);
    program.upper = Eigen::VectorXd::Zero(variables);
    program.lower.head(from.variables()) = from.lower;
    program.upper.head(from.variables()) = from.upper;
    program.sphere_variables = from.sphere_variables;
    return lifted;
}

bool prefers_lifted(const OrbitProgram& condensed, const Kernel& kernel) {
    const auto& rows = condensed.program.inequalities;
    const double lifted = static_cast<double>(kernel.pattern.period_steps()) + 2.0 * static_cast<double>(rows.rows());
    return rows.rows() >= lifted_rows && static_cast<double>(rows.nonZeros()) > lifted_ratio * lifted;
}

}  // namespace nsma
