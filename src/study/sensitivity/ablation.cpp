#include "nsma/study/sensitivity/sensitivity.hpp"

#include "numerics/linear_program.hpp"

namespace nsma {
namespace {

constexpr unsigned cond1 = 1, cond2 = 2, cond3 = 4;
// Directions are sought in a unit box over small integer rows.
constexpr double direction_tolerance = 1e-7;

// Rows of the chosen conditions; `homogeneous` drops the gap, for cones.
LinearProgram chosen_rows(const RelaxedSet& set, unsigned kept, double gap, double box) {
    const int m = set.dimension();
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < set.condition.size(); ++i) {
        const bool flight = set.condition[i].condition == ConditionRow::Condition::cond1;
        if ((kept & (flight ? cond1 : cond3)) != 0) rows.push_back(static_cast<Eigen::Index>(i));
    }
    const auto count = static_cast<Eigen::Index>(rows.size());
    // COND2's row: an equality, or COND1 at the ends of the flight.
    const bool contact = (kept & (cond1 | cond2)) != 0;
    LinearProgram program;
    program.rows.resize(count + (contact ? 1 : 0), m);
    program.row_lower = Eigen::VectorXd::Constant(program.rows.rows(), -no_bound);
    program.row_upper = Eigen::VectorXd::Zero(program.rows.rows());
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto row = rows[static_cast<std::size_t>(i)];
        program.rows.row(i) = set.rows.row(row);
        if (set.condition[static_cast<std::size_t>(row)].condition == ConditionRow::Condition::cond1) {
            program.row_upper[i] = gap;
        }
    }
    if (contact) {
        program.rows.row(count) = set.contact.transpose();
        program.row_upper[count] = gap;
        if ((kept & cond2) != 0) program.row_lower[count] = gap;
    }
    program.lower = Eigen::VectorXd::Constant(m, -box);
    program.upper = Eigen::VectorXd::Constant(m, box);
    return program;
}

bool cone_has_direction(const RelaxedSet& set, unsigned kept) {
    LinearSolver solver(chosen_rows(set, kept, 0.0, 1.0));
    for (int j = 0; j < set.dimension(); ++j) {
        for (const double side : {-1.0, 1.0}) {
            Eigen::VectorXd cost = Eigen::VectorXd::Zero(set.dimension());
            cost[j] = side;
            const LinearSolution solution = solver.minimise(cost);
            if (solution.status == LinearStatus::optimal && solution.value < -direction_tolerance) return true;
        }
    }
    return false;
}

bool survives(const RelaxedSet& set, const Conditions& signs, unsigned kept) {
    if (kept == 0) return true;
    const auto some_sign = [&] {
        for (const auto bound : signs.bound_of) {
            if (bound != Conditions::Sign::zero) return true;
        }
        return false;
    };
    const bool held = (kept & cond2) != 0;
    // Away from the wall a small enough motion meets COND1, whatever its shape.
    if (set.gap_sign > 0 && !held) kept &= ~cond1;
    if (kept == 0) return true;
    if (kept == cond3) return some_sign();
    if (set.gap_sign == 0) return cone_has_direction(set, kept);
    LinearSolver solver(chosen_rows(set, kept, set.gap_sign, no_bound));
    return solver.minimise(Eigen::VectorXd::Zero(set.dimension())).status == LinearStatus::optimal;
}

}  // namespace

AblationRecord ablation_record(const Kernel& kernel, int gap_sign) {
    AblationRecord record;
    record.pattern = kernel.pattern;
    record.kernel_dimension = kernel.dimension();
    record.kind = pattern_kind(kernel.pattern);
    if (kernel.dimension() == 0) return record;
    const RelaxedSet set = relaxed_set(kernel, gap_sign);
    const Conditions signs = conditions(kernel, gap_sign);
    for (unsigned kept = 0; kept < 8; ++kept) record.survives[kept] = survives(set, signs, kept);
    return record;
}

}  // namespace nsma
