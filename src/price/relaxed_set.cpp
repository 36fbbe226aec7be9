#include "nsma/price/relaxed_set.hpp"

#include <stdexcept>
#include <utility>

#include "numerics/expect_size.hpp"

namespace nsma {
namespace {

using Condition = ConditionRow::Condition;

// Rows in the order of their first step; equal rows of a condition become one.
struct Rows {
    std::vector<Eigen::RowVectorXd> rows;
    std::vector<ConditionRow> conditions;

    void add(Condition condition, int step, const Eigen::RowVectorXd& row) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (conditions[i].condition != condition || rows[i] != row) continue;
            conditions[i].steps.push_back(step);
            return;
        }
        rows.push_back(row);
        conditions.push_back({condition, {step}});
    }
};

}  // namespace

Eigen::VectorXd RelaxedSet::limits(const Shift& shift) const {
    if (shift.rows.size() > 0) expect_size("rows", rows.rows(), shift.rows.size());
    Eigen::VectorXd result = shift.rows.size() > 0 ? shift.rows : Eigen::VectorXd::Zero(rows.rows());
    for (std::size_t i = 0; i < condition.size(); ++i) {
        if (condition[i].condition == Condition::cond1) {
            result[static_cast<Eigen::Index>(i)] += gap_sign + shift.gap;
        }
    }
    return result;
}

Shift RelaxedSet::shift(const Relaxation& relaxation) const {
    Shift result;
    result.band = relaxation.band;
    result.rows.resize(rows.rows());
    for (std::size_t i = 0; i < condition.size(); ++i) {
        result.rows[static_cast<Eigen::Index>(i)] =
            condition[i].condition == Condition::cond1 ? relaxation.penetration : relaxation.adhesion;
    }
    return result;
}

RelaxedSet relaxed_set(const Kernel& kernel, int gap_sign) {
    if (kernel.dimension() == 0) {
        throw std::invalid_argument("kernel: expected dimension >= 1, got 0");
    }
    RelaxedSet set;
    set.kernel = kernel;
    set.gap_sign = gap_sign;
    set.energy_factor = conditions(kernel, gap_sign).energy_factor();  // checks the gap sign
    const Eigen::MatrixXd tip = tip_rows(kernel).cast<double>();
    set.contact = tip.row(0);
    Rows found;
    const int r = kernel.pattern.free_steps;
    for (int n = 1; n < r; ++n) {
        if (tip.row(n) != tip.row(0)) found.add(Condition::cond1, n, tip.row(n));
    }
    for (int n = r; n < kernel.pattern.period_steps(); ++n) {
        const int column = kernel.column(n);
        if (column < 0) continue;
        const double tension = -2.0 * kernel.pattern.cells * kernel.sign[static_cast<std::size_t>(n)];
        found.add(Condition::cond3, n, tension * Eigen::RowVectorXd::Unit(kernel.dimension(), column));
    }
    set.rows.resize(static_cast<Eigen::Index>(found.rows.size()), kernel.dimension());
    for (Eigen::Index i = 0; i < set.rows.rows(); ++i) set.rows.row(i) = found.rows[static_cast<std::size_t>(i)];
    set.condition = std::move(found.conditions);
    return set;
}

}  // namespace nsma
