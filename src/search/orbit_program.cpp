#include "orbit_program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nsma {
namespace {

using Triplet = Eigen::Triplet<double>;

// Column of beta -> reduced variable, -1 where presolve fixed it to zero.
std::vector<int> reduced_index(const Reduction& reduction) {
    std::vector<int> index(static_cast<std::size_t>(reduction.kernel_dimension), -1);
    for (int j = 0; j < reduction.variables(); ++j) {
        index[static_cast<std::size_t>(reduction.column[static_cast<std::size_t>(j)])] = j;
    }
    return index;
}

struct Term {
    int variable = -1;
    double factor = 0;
};

// b_n as factor * gamma_variable, steps taken cyclically.
class Waves {
public:
    Waves(const Reduction& reduction, const Kernel& kernel)
        : reduction_(reduction), kernel_(kernel), index_(reduced_index(reduction)) {}

    [[nodiscard]] Term operator()(int n) const {
        n %= kernel_.pattern.period_steps();
        const int column = kernel_.column(n);
        if (column < 0) return {};
        const int j = index_[static_cast<std::size_t>(column)];
        if (j < 0) return {};
        return {j, static_cast<double>(reduction_.flip[static_cast<std::size_t>(j)] *
                                       kernel_.sign[static_cast<std::size_t>(n)])};
    }

private:
    const Reduction& reduction_;
    const Kernel& kernel_;
    std::vector<int> index_;
};

// Adds factor * (a - b)^2 to the Hessian of the objective x' H x / 2.
void add_square(std::vector<Triplet>& hessian, double factor, const Term& a, const Term& b) {
    const auto add = [&](const Term& p, const Term& q, double sign) {
        if (p.variable < 0 || q.variable < 0) return;
        hessian.emplace_back(p.variable, q.variable, 2.0 * factor * sign * p.factor * q.factor);
    };
    add(a, a, 1);
    add(b, b, 1);
    add(a, b, -1);
    add(b, a, -1);
}

SparseRows scaled_rows(const Eigen::MatrixXi& rows, Eigen::Index variables, const std::vector<int>& capped) {
    std::vector<Triplet> entries;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const double norm = rows.row(i).cast<double>().norm();
        for (Eigen::Index j = 0; j < rows.cols(); ++j) {
            if (rows(i, j) != 0) {
                entries.emplace_back(static_cast<int>(i), static_cast<int>(j), rows(i, j) / norm);
            }
        }
    }
    auto row = static_cast<int>(rows.rows());
    for (const int j : capped) {  // (gamma_j - peak)/sqrt(2) <= 0
        entries.emplace_back(row, j, M_SQRT1_2);
        entries.emplace_back(row, static_cast<int>(variables) - 1, -M_SQRT1_2);
        ++row;
    }
    SparseRows result(row, variables);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

void set_constraints(OrbitProgram& result, const Reduction& reduction, bool peak) {
    auto& program = result.program;
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    const Eigen::Index variables = n + (peak ? 1 : 0);
    result.orbit_variables = static_cast<int>(n);
    program.lower = Eigen::VectorXd::Zero(variables);
    program.upper = Eigen::VectorXd::Constant(variables, no_bound);
    std::vector<int> capped;
    for (int j = 0; j < reduction.variables(); ++j) {
        const bool bounded = reduction.bounded[static_cast<std::size_t>(j)] != 0;
        if (!bounded) program.lower[j] = -no_bound;
        if (bounded && peak) capped.push_back(j);
    }
    program.inequalities = scaled_rows(reduction.rows, variables, capped);
    program.inequality_values = Eigen::VectorXd::Zero(program.inequalities.rows());

    const Eigen::VectorXd contact = reduction.contact_row.cast<double>();
    const double norm = contact.norm();
    program.equalities.resize(norm > 0 ? 1 : 0, variables);
    program.equality_values = Eigen::VectorXd::Zero(program.equalities.rows());
    if (norm > 0) {
        for (Eigen::Index j = 0; j < n; ++j) {
            if (contact[j] != 0) program.equalities.insert(0, j) = contact[j] / norm;
        }
        program.equality_values[0] = reduction.gap_sign / (norm * result.scale);
    }
    program.equalities.makeCompressed();
}

}  // namespace

Eigen::VectorXd OrbitProgram::gamma(const Eigen::VectorXd& x) const { return scale * x.head(orbit_variables); }

Eigen::VectorXd OrbitProgram::point(const Eigen::VectorXd& gamma) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(program.variables());
    x.head(orbit_variables) = gamma / scale;
    if (program.variables() > orbit_variables) {
        double peak = 0;
        for (Eigen::Index j = 0; j < orbit_variables; ++j) {
            if (program.lower[j] == 0) peak = std::max(peak, x[j]);
        }
        x[orbit_variables] = peak;
    }
    return x;
}

OrbitProgram orbit_program(const Reduction& reduction, const Kernel& kernel, Objective objective,
                           std::optional<double> level, double reference_energy, const Eigen::VectorXd& reference) {
    const bool extreme = is_extreme(objective);
    if (extreme == level.has_value()) {
        throw std::invalid_argument(std::string("level: expected ") + (extreme ? "none" : "one") + " for objective " +
                                    std::string(name(objective)));
    }
    const double energy = level.value_or(reference_energy);
    if (!(energy > 0) || !std::isfinite(energy)) {
        throw std::invalid_argument("level: expected a finite number > 0, got " + std::to_string(energy));
    }
    OrbitProgram result;
    result.scale = std::sqrt(energy / reduction.energy_factor);
    set_constraints(result, reduction, objective == Objective::least_force);
    auto& program = result.program;
    const auto variables = program.variables();
    program.gradient = Eigen::VectorXd::Zero(variables);
    program.hessian.resize(variables, variables);
    if (level) program.sphere_variables = result.orbit_variables;

    const int window = 2 * kernel.pattern.cells;
    const Waves wave(reduction, kernel);
    // In x, 2N sum b^2 over one window is `energy` |x|^2; objectives are divided by `energy`.
    const double unit = window * result.scale * result.scale / energy;
    std::vector<Triplet> hessian;
    result.objective_unit = energy;
    switch (objective) {
        case Objective::least_shock:
            for (int n = 0; n < kernel.pattern.period_steps(); ++n) {
                add_square(hessian, unit, wave(n + 1), wave(n));
            }
            break;
        case Objective::nearest: {
            if (reference.size() != window) {
                throw std::invalid_argument("reference: expected size " + std::to_string(window) + ", got " +
                                            std::to_string(reference.size()));
            }
            const Eigen::VectorXd target = reference / result.scale;
            program.constant = unit * target.squaredNorm();
            for (int n = 0; n < window; ++n) {
                const Term term = wave(n);
                if (term.variable < 0) continue;
                hessian.emplace_back(term.variable, term.variable, 2.0 * unit);
                program.gradient[term.variable] -= 2.0 * unit * term.factor * target[n];
            }
            break;
        }
        case Objective::least_force:
            program.gradient[variables - 1] = 1.0;
            result.objective_unit = window * result.scale;
            break;
        case Objective::min_energy:
        case Objective::max_energy: {
            const double sign = objective == Objective::min_energy ? 1.0 : -1.0;
            for (int j = 0; j < result.orbit_variables; ++j) hessian.emplace_back(j, j, 2.0 * sign);
            result.objective_unit = sign * energy;
            break;
        }
    }
    program.hessian.setFromTriplets(hessian.begin(), hessian.end());
    return result;
}

double objective_of_waves(const Kernel& kernel, Objective objective, const Eigen::VectorXd& beta,
                          const Eigen::VectorXd& reference) {
    const int steps = kernel.pattern.period_steps();
    const double window = 2.0 * kernel.pattern.cells;
    const auto wave = [&](int n) {
        n %= steps;
        const int column = kernel.column(n);
        return column < 0 ? 0.0 : kernel.sign[static_cast<std::size_t>(n)] * beta[column];
    };
    double sum = 0;
    switch (objective) {
        case Objective::least_shock:
            for (int n = 0; n < steps; ++n) sum += std::pow(wave(n + 1) - wave(n), 2);
            return window * sum;
        case Objective::nearest:
            for (int n = 0; n < 2 * kernel.pattern.cells; ++n) sum += std::pow(wave(n) - reference[n], 2);
            return window * sum;
        case Objective::least_force:
            for (int n = kernel.pattern.free_steps; n < steps; ++n) sum = std::max(sum, std::abs(wave(n)));
            return window * sum;
        default:
            for (int n = 0; n < 2 * kernel.pattern.cells; ++n) sum += std::pow(wave(n), 2);
            return window * sum;
    }
}

}  // namespace nsma
