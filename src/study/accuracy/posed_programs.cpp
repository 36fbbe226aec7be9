#include "posed_programs.hpp"

#include <cmath>

#include "nsma/orbit/conditions.hpp"

namespace nsma {
namespace {

// Puts more rows below those of a constraint.
void append(SparseRows& rows, Eigen::VectorXd& values, const Eigen::MatrixXd& more,
            const Eigen::VectorXd& more_values) {
    Eigen::MatrixXd all_rows(rows.rows() + more.rows(), more.cols());
    all_rows << Eigen::MatrixXd(rows), more;
    rows = all_rows.sparseView();
    Eigen::VectorXd all_values(values.size() + more_values.size());
    all_values << values, more_values;
    values = all_values;
}

// COND2 once for each of the p contact steps and n = 0.
void repeat_contact(const ProgramCase& on, Program& program) {
    if (program.equalities.rows() == 0) return;
    const Eigen::MatrixXd row = Eigen::MatrixXd(program.equalities).topRows(1);
    const int times = on.problem.kernel.pattern.contact_steps;
    append(program.equalities, program.equality_values, row.replicate(times, 1),
           program.equality_values.head(1).replicate(times, 1));
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
    append(program.inequalities, program.inequality_values, rows, Eigen::VectorXd::Zero(count));
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
    append(program.inequalities, program.inequality_values, rows, values);
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
    using Change = void (*)(const ProgramCase&, Program&);
    static const std::vector<std::pair<const char*, std::vector<Change>>> variants{
        {"presolved", {}},
        {"COND2 repeated", {repeat_contact}},
        {"COND3 as rows", {force_rows}},
        {"all COND1 rows", {flight_rows}},
        {"all of them", {repeat_contact, force_rows, flight_rows}}};
    std::vector<PosedProgram> posed;
    for (const auto& [what, changes] : variants) {
        posed.push_back({what, on.program.program});
        for (const Change change : changes) change(on, posed.back().program);
    }
    return posed;
}

}  // namespace nsma
