#pragma once

#include "nsma/program/linear_program.hpp"
#include "nsma/program/reduction.hpp"

namespace nsma {

/// The kept rows of COND1 (<= 0) and, last, COND2 (contact_row . gamma = contact) as a linear program over gamma, whose
/// bounds the caller sets.
[[nodiscard]] inline LinearProgram conditions_program(const Reduction& reduction, double contact) {
    const auto count = reduction.rows.rows();
    LinearProgram program;
    program.rows.resize(count + 1, reduction.variables());
    program.rows.topRows(count) = reduction.rows.cast<double>();
    program.rows.row(count) = reduction.contact_row.cast<double>().transpose();
    program.row_lower = Eigen::VectorXd::Constant(count + 1, -no_bound);
    program.row_upper = Eigen::VectorXd::Zero(count + 1);
    program.row_lower[count] = contact;
    program.row_upper[count] = contact;
    return program;
}

}  // namespace nsma
