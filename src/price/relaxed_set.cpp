#include "nsma/price/relaxed_set.hpp"
#include "relaxed_program.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace nsma {
namespace {

using Condition = ConditionRow::Condition;
using Triplet = Eigen::Triplet<double>;

// Collects rows in the order of their first step; equal rows become one.
class Rows {
public:
    void add(Condition condition, int step, std::vector<int> row) {
        const auto [place, fresh] = index_.try_emplace({condition, std::move(row)}, kinds.size());
        if (fresh) {
            kinds.push_back({condition, {}});
            keys_.push_back(&place->first.second);
        }
        kinds[place->second].steps.push_back(step);
    }

    [[nodiscard]] Eigen::MatrixXd matrix(int columns) const {
        Eigen::MatrixXd result(static_cast<Eigen::Index>(kinds.size()), columns);
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            for (int j = 0; j < columns; ++j) {
                result(static_cast<Eigen::Index>(i), j) = (*keys_[i])[static_cast<std::size_t>(j)];
            }
        }
        return result;
    }

    std::vector<ConditionRow> kinds;

private:
    std::map<std::pair<Condition, std::vector<int>>, std::size_t> index_;
    std::vector<const std::vector<int>*> keys_;
};

// Adds 2 factor (a - b)^2 / 2 of two signed unknowns to the Hessian.
void add_square(std::vector<Triplet>& hessian, double factor, int a, double sign_a, int b, double sign_b) {
    if (a >= 0) hessian.emplace_back(a, a, 2 * factor * sign_a * sign_a);
    if (b >= 0) hessian.emplace_back(b, b, 2 * factor * sign_b * sign_b);
    if (a < 0 || b < 0) return;
    hessian.emplace_back(a, b, -2 * factor * sign_a * sign_b);
    hessian.emplace_back(b, a, -2 * factor * sign_a * sign_b);
}

void set_objective(RelaxedProgram& result, const RelaxedSet& set, Objective objective, double energy,
                   const Eigen::VectorXd& reference) {
    const Kernel& kernel = set.kernel;
    const int m = set.dimension();
    const int steps = kernel.pattern.period_steps();
    const double window = 2.0 * kernel.pattern.cells;
    auto& program = result.program;
    std::vector<Triplet> hessian;
    switch (objective) {
        case Objective::least_shock: {
            const auto sign = [&](int n) {
                return static_cast<double>(kernel.sign[static_cast<std::size_t>(n % steps)]);
            };
            for (int n = 0; n < steps; ++n) {
                add_square(hessian, 1.0, kernel.column(n), sign(n), kernel.column((n + 1) % steps), sign(n + 1));
            }
            result.objective_unit = window * result.scale * result.scale;
            break;
        }
        case Objective::nearest: {
            if (reference.size() != static_cast<Eigen::Index>(window)) {
                throw std::invalid_argument("reference: expected size " + std::to_string(static_cast<int>(window)) +
                                            ", got " + std::to_string(reference.size()));
            }
            // 2N |W beta - ref|^2 with W'W = (2N/g) I; in x the unit is the energy of the level.
            const double per_class = window / kernel.classes;
            for (int j = 0; j < m; ++j) hessian.emplace_back(j, j, 2.0);
            program.gradient.head(m) = -2.0 / (per_class * result.scale) * (wave_basis(kernel).transpose() * reference);
            program.constant = reference.squaredNorm() / (per_class * result.scale * result.scale);
            result.objective_unit = energy;
            break;
        }
        case Objective::least_force:
            program.gradient[m] = 1.0;
            result.objective_unit = window * result.scale;
            break;
        case Objective::min_energy:
        case Objective::max_energy: {
            const double sign = objective == Objective::min_energy ? 1.0 : -1.0;
            for (int j = 0; j < m; ++j) hessian.emplace_back(j, j, 2.0 * sign);
            result.objective_unit = sign * energy;
            break;
        }
    }
    program.hessian.setFromTriplets(hessian.begin(), hessian.end());
}

}  // namespace

Eigen::VectorXd RelaxedSet::limits(const Shift& shift) const {
    if (shift.rows.size() != 0 && shift.rows.size() != rows.rows()) {
        throw std::invalid_argument("rows: expected size " + std::to_string(rows.rows()) + ", got " +
                                    std::to_string(shift.rows.size()));
    }
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
    const int m = kernel.dimension();
    const Eigen::VectorXi contact = contact_row(kernel);
    set.contact = contact.cast<double>();

    Rows rows;
    std::vector<int> row(contact.begin(), contact.end());
    const std::vector<int> at_wall = row;
    const int r = kernel.pattern.free_steps;
    for (int n = 0; n + 1 < r; ++n) {
        const int column = kernel.column(n);
        if (column >= 0) {
            row[static_cast<std::size_t>(column)] += 2 * kernel.sign[static_cast<std::size_t>(n)];
        }
        if (row != at_wall) rows.add(Condition::cond1, n + 1, row);
    }
    for (int n = r; n < kernel.pattern.period_steps(); ++n) {
        const int column = kernel.column(n);
        if (column < 0) continue;
        std::vector<int> tension(static_cast<std::size_t>(m), 0);
        tension[static_cast<std::size_t>(column)] =
            -2 * kernel.pattern.cells * kernel.sign[static_cast<std::size_t>(n)];
        rows.add(Condition::cond3, n, std::move(tension));
    }
    set.rows = rows.matrix(m);
    set.condition = std::move(rows.kinds);
    return set;
}

Eigen::VectorXd RelaxedProgram::point(const Eigen::VectorXd& beta) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(program.variables());
    x.head(orbit_variables) = beta / scale;
    if (program.variables() > orbit_variables) {
        double peak = 0;  // least value that its rows (the last ones) allow
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
    const bool peak = objective == Objective::least_force;
    const int m = set.dimension();
    RelaxedProgram result;
    auto& program = result.program;
    const Eigen::Index variables = m + (peak ? 1 : 0);
    result.scale = std::sqrt(level / set.energy_factor);
    result.orbit_variables = m;
    program.lower = Eigen::VectorXd::Constant(variables, -no_bound);
    program.upper = Eigen::VectorXd::Constant(variables, no_bound);
    program.gradient = Eigen::VectorXd::Zero(variables);
    program.hessian.resize(variables, variables);
    program.sphere_variables = extreme ? 0 : m;
    if (!extreme && shift.level != 0) {
        // The sphere of the program has radius one: the scale carries the level.
        result.scale *= std::sqrt((level + shift.level) / level);
    }
    set_objective(result, set, objective, level + (extreme ? 0.0 : shift.level), reference);

    std::vector<Triplet> entries;
    std::vector<double> values;
    const auto add = [&](const Eigen::VectorXd& row, double norm, double limit) {
        const auto number = static_cast<int>(values.size());
        for (int j = 0; j < m; ++j) {
            if (row[j] != 0) entries.emplace_back(number, j, row[j] / norm);
        }
        values.push_back(limit / (norm * result.scale));
    };
    const Eigen::VectorXd limits = set.limits(shift);
    result.row_norm = set.rows.rowwise().norm();
    for (double& norm : result.row_norm) {
        if (norm == 0) norm = 1.0;  // a tip that never moves: 0 <= limit
    }
    for (Eigen::Index i = 0; i < set.rows.rows(); ++i) {
        add(set.rows.row(i), result.row_norm[i], limits[i]);
    }
    result.contact_norm = set.contact.norm();
    const double place = set.gap_sign + shift.gap + shift.contact;
    if (peak) {
        std::vector<char> pushed(static_cast<std::size_t>(m), 0);
        for (int n = set.kernel.pattern.free_steps; n < set.kernel.pattern.period_steps(); ++n) {
            if (set.kernel.column(n) >= 0) pushed[static_cast<std::size_t>(set.kernel.column(n))] = 1;
        }
        for (int j = 0; j < m; ++j) {
            for (const double side : {1.0, -1.0}) {
                if (pushed[static_cast<std::size_t>(j)] == 0) continue;
                const auto number = static_cast<int>(values.size());
                entries.emplace_back(number, j, side * M_SQRT1_2);
                entries.emplace_back(number, m, -M_SQRT1_2);
                values.push_back(0.0);
                ++result.peak_rows;
            }
        }
        if (result.peak_rows == 0) {  // no contact step carries a wave: no force, rather than one below zero
            entries.emplace_back(static_cast<int>(values.size()), m, -1.0);
            values.push_back(0.0);
            ++result.peak_rows;
        }
    }
    const bool banded = shift.band > 0 && result.contact_norm > 0;
    if (banded) {
        add(set.contact, result.contact_norm, place + shift.band);
        add(-set.contact, result.contact_norm, shift.band - place);
    }
    program.inequalities.resize(static_cast<Eigen::Index>(values.size()), variables);
    program.inequalities.setFromTriplets(entries.begin(), entries.end());
    program.inequality_values =
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));

    // A row of zeros cannot meet a gap: the program keeps it as 0 = 1, which no point satisfies.
    const bool impossible = result.contact_norm == 0 && std::abs(place) > shift.band;
    const bool equality = (result.contact_norm > 0 && !banded) || impossible;
    program.equalities.resize(equality ? 1 : 0, variables);
    program.equality_values = Eigen::VectorXd::Zero(equality ? 1 : 0);
    if (impossible) {
        program.equality_values[0] = 1.0;
    } else if (equality) {
        for (int j = 0; j < m; ++j) {
            if (set.contact[j] != 0) program.equalities.insert(0, j) = set.contact[j] / result.contact_norm;
        }
        program.equality_values[0] = place / (result.contact_norm * result.scale);
    }
    program.equalities.makeCompressed();
    return result;
}

}  // namespace nsma
