#include "relaxed_program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "numerics/expect_size.hpp"

namespace nsma {
namespace {

// `energy`: that of the sphere, or of the scale where there is none.
void set_objective(RelaxedProgram& result, const RelaxedSet& set, Objective objective, double energy,
                   const Eigen::VectorXd& reference) {
    const Kernel& kernel = set.kernel;
    const int m = set.dimension();
    const int window = 2 * kernel.pattern.cells;
    auto& program = result.program;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(program.variables(), program.variables());
    result.objective_unit = energy;
    switch (objective) {
        case Objective::least_shock: {
            const int steps = kernel.pattern.period_steps();
            Eigen::MatrixXd wave(steps, m);  // b_n over beta
            for (int j = 0; j < m; ++j) wave.col(j) = kernel.waves(Eigen::VectorXd::Unit(m, j));
            Eigen::MatrixXd jump(steps, m);
            jump << wave.bottomRows(steps - 1) - wave.topRows(steps - 1), wave.row(0) - wave.row(steps - 1);
            hessian = 2.0 * jump.transpose() * jump;
            result.objective_unit = window * result.scale * result.scale;
            break;
        }
        case Objective::nearest: {
            expect_size("reference", window, reference.size());
            // 2N |W beta - ref|^2 with W'W = (2N/g) I; in x the unit is the energy of the level.
            const double per_class = static_cast<double>(window) / kernel.classes;
            hessian.diagonal().setConstant(2.0);
            program.gradient = -2.0 / (per_class * result.scale) * (wave_basis(kernel).transpose() * reference);
            program.constant = reference.squaredNorm() / (per_class * result.scale * result.scale);
            break;
        }
        case Objective::least_force:
            program.gradient[m] = 1.0;
            result.objective_unit = window * result.scale;
            break;
        case Objective::min_energy: hessian.diagonal().setConstant(2.0); break;
        case Objective::max_energy:
            hessian.diagonal().setConstant(-2.0);
            result.objective_unit = -energy;
            break;
    }
    program.hessian = hessian.sparseView();
}

// |beta_j| <= peak for every column that carries a wave in contact, over (beta, peak); without any no force, rather
// than one below zero.
Eigen::MatrixXd peak_rows(const RelaxedSet& set) {
    const int m = set.dimension();
    std::vector<char> pushed(static_cast<std::size_t>(m), 0);
    for (std::size_t i = 0; i < set.condition.size(); ++i) {
        if (set.condition[i].condition != ConditionRow::Condition::cond3) continue;
        pushed[static_cast<std::size_t>(set.kernel.column(set.condition[i].steps.front()))] = 1;
    }
    const auto count = std::count(pushed.begin(), pushed.end(), 1);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(2 * count, 1), m + 1);
    rows.col(m).setConstant(count > 0 ? -M_SQRT1_2 : -1.0);
    Eigen::Index row = 0;
    for (int j = 0; j < m; ++j) {
        if (pushed[static_cast<std::size_t>(j)] == 0) continue;
        rows(row++, j) = M_SQRT1_2;
        rows(row++, j) = -M_SQRT1_2;
    }
    return rows;
}

}  // namespace

Eigen::VectorXd RelaxedProgram::point(const Eigen::VectorXd& beta) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(program.variables());
    x.head(orbit_variables) = beta / scale;
    if (program.variables() > orbit_variables) {
        double peak = 0;  // least value that its rows allow
        for (Eigen::Index i = row_norm.size(); i < row_norm.size() + peak_rows; ++i) {
            peak = std::max(peak, program.inequalities.row(i).dot(x) * M_SQRT2);
        }
        x[orbit_variables] = peak;
    }
    return x;
}

RelaxedProgram relaxed_program(const RelaxedSet& set, Objective objective, double level, const Shift& shift,
                               const Eigen::VectorXd& reference) {
    if (!(level > 0) || !std::isfinite(level)) {
        throw std::invalid_argument("level: expected a finite number > 0, got " + std::to_string(level));
    }
    const bool extreme = is_extreme(objective);
    const int m = set.dimension();
    RelaxedProgram result;
    auto& program = result.program;
    const Eigen::MatrixXd peak = objective == Objective::least_force ? peak_rows(set) : Eigen::MatrixXd(0, m);
    const Eigen::Index variables = peak.cols();
    const double energy = level + (extreme ? 0.0 : shift.level);
    // The sphere of the program has radius one: the scale carries the level.
    result.scale = std::sqrt(level / set.energy_factor) * std::sqrt(energy / level);
    result.orbit_variables = m;
    result.peak_rows = static_cast<int>(peak.rows());
    program.lower = Eigen::VectorXd::Constant(variables, -no_bound);
    program.upper = Eigen::VectorXd::Constant(variables, no_bound);
    program.gradient = Eigen::VectorXd::Zero(variables);
    program.sphere_variables = extreme ? 0 : m;
    set_objective(result, set, objective, energy, reference);

    result.row_norm = set.rows.rowwise().norm();
    result.row_norm =
        (result.row_norm.array() == 0).select(1.0, result.row_norm);  // a tip that never moves: 0 <= limit
    result.contact_norm = set.contact.norm();
    const double place = set.gap_sign + shift.gap + shift.contact;
    const bool banded = shift.band > 0 && result.contact_norm > 0;
    const auto count = set.rows.rows();
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count + peak.rows() + (banded ? 2 : 0), variables);
    program.inequality_values = Eigen::VectorXd::Zero(rows.rows());
    rows.topLeftCorner(count, m) = set.rows.array().colwise() / result.row_norm.array();
    program.inequality_values.head(count) = set.limits(shift).array() / (result.row_norm.array() * result.scale);
    rows.middleRows(count, peak.rows()) = peak;
    if (banded) {
        rows.bottomLeftCorner(2, m).row(0) = set.contact.transpose() / result.contact_norm;
        rows.bottomLeftCorner(2, m).row(1) = -set.contact.transpose() / result.contact_norm;
        program.inequality_values.tail(2) =
            Eigen::Vector2d(place + shift.band, shift.band - place) / (result.contact_norm * result.scale);
    }
    program.inequalities = rows.sparseView();

    // A row of zeros cannot meet a gap: the program keeps it as 0 = 1, which no point satisfies.
    const bool impossible = result.contact_norm == 0 && std::abs(place) > shift.band;
    const bool equality = (result.contact_norm > 0 && !banded) || impossible;
    Eigen::MatrixXd contact = Eigen::MatrixXd::Zero(equality ? 1 : 0, variables);
    program.equality_values = Eigen::VectorXd::Constant(contact.rows(), 1.0);
    if (equality && !impossible) {
        contact.leftCols(m) = set.contact.transpose() / result.contact_norm;
        program.equality_values[0] = place / (result.contact_norm * result.scale);
    }
    program.equalities = contact.sparseView();
    return result;
}

}  // namespace nsma
