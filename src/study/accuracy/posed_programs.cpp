#include "posed_programs.hpp"

#include <cmath>

#include "nsma/orbit/conditions.hpp"

namespace nsma {
namespace {

// One matrix, or vector, above another.
SparseRows stacked(const SparseRows& above, const Eigen::MatrixXd& below) {
    Eigen::MatrixXd all(above.rows() + below.rows(), below.cols());
    all << Eigen::MatrixXd(above), below;
    return all.sparseView();
}

Eigen::VectorXd stacked(const Eigen::VectorXd& above, const Eigen::VectorXd& below) {
    Eigen::VectorXd all(above.size() + below.size());
    all << above, below;
    return all;
}

// COND2 once for each of the p contact steps and n = 0.
void repeat_contact(const ProgramCase& on, Program& program) {
    if (program.equalities.rows() == 0) return;
    const Eigen::MatrixXd row = Eigen::MatrixXd(program.equalities).topRows(1);
    const int times = on.problem.kernel.pattern.contact_steps;
    program.equalities = stacked(program.equalities, row.replicate(times, 1));
    program.equality_values = stacked(program.equality_values, program.equality_values.head(1).replicate(times, 1));
}

// COND3 at each contact step as a row -gamma_j <= 0 in place of the bound.
void force_rows(const ProgramCase& on, Program& program) {
    const Kernel& kernel = on.problem.kernel;
    const Reduction& reduction = on.problem.set.reduction;
    std::vector<Eigen::Index> columns;
    for (int n = kernel.pattern.free_steps; n < kernel.pattern.period_steps(); ++n) {
        for (int j = 0; j < reduction.variables(); ++j) {
            if (reduction.column[static_cast<std::size_t>(j)] == kernel.column(n)) columns.push_back(j);
        }
    }
    const auto count = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, program.variables());
    for (Eigen::Index i = 0; i < count; ++i) rows(i, columns[static_cast<std::size_t>(i)]) = -1.0;
    program.inequalities = stacked(program.inequalities, rows);
    program.inequality_values = stacked(program.inequality_values, Eigen::VectorXd::Zero(count));
    program.lower.head(reduction.variables()).setConstant(-no_bound);
}

// COND1 x_n <= delta at each step of the free flight, silent and implied ones too.
void flight_rows(const ProgramCase& on, Program& program) {
    const Reduction& reduction = on.problem.set.reduction;
    const Eigen::MatrixXi tips = tip_rows(on.problem.kernel);
    const int count = on.problem.kernel.pattern.free_steps - 1;
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, program.variables());
    Eigen::VectorXd values(count);
    for (int n = 0; n < count; ++n) {
        for (int j = 0; j < reduction.variables(); ++j) {
            const auto k = static_cast<std::size_t>(j);
            rows(n, j) = reduction.flip[k] * tips(n + 1, reduction.column[k]);
        }
        const double norm = std::max(rows.row(n).norm(), 1.0);
        rows.row(n) /= norm;
        values[n] = reduction.gap_sign / (norm * on.program.scale);
    }
    program.inequalities = stacked(program.inequalities, rows);
    program.inequality_values = stacked(program.inequality_values, values);
}

}  // namespace

std::vector<PosedProgram> scaled_programs(const Program& program, bool quick) {
    const std::vector<int> powers = quick ? std::vector{-6, 6} : std::vector{-12, -9, -6, -3, 0, 3, 6, 9, 12};
    std::vector<PosedProgram> posed;
    for (const int power : powers) {
        const double unit = std::pow(10.0, power);
        PosedProgram one{"1e" + std::to_string(power), program};
        one.program.hessian *= unit;
        one.program.gradient *= unit;
        one.program.constant *= unit;
        one.program.equalities *= unit;
        one.program.equality_values *= unit;
        one.program.inequalities *= unit;
        one.program.inequality_values *= unit;
        posed.push_back(std::move(one));
    }
    return posed;
}

std::vector<PosedProgram> redundant_programs(const ProgramCase& on) {
    std::vector<PosedProgram> posed;
    const auto add = [&](const char* what, bool contact, bool force, bool flight) {
        PosedProgram one{what, on.program.program};
        if (contact) repeat_contact(on, one.program);
        if (force) force_rows(on, one.program);
        if (flight) flight_rows(on, one.program);
        posed.push_back(std::move(one));
    };
    add("presolved", false, false, false);
    add("COND2 repeated", true, false, false);
    add("COND3 as rows", false, true, false);
    add("all COND1 rows", false, false, true);
    add("all of them", true, true, true);
    return posed;
}

}  // namespace nsma
