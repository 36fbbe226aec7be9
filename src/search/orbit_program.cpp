#include "orbit_program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "numerics/expect_size.hpp"

namespace nsma {
namespace {

using Triplet = Eigen::Triplet<double>;

// b_n as factor * gamma_variable; no variable where it is zero.
struct Term {
    int variable = -1;
    double factor = 0;
};

Term wave_term(const Reduction& reduction, const Kernel& kernel, int n) {
    n %= kernel.pattern.period_steps();
    return {kernel.column(n), static_cast<double>(reduction.flip * kernel.sign[static_cast<std::size_t>(n)])};
}

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

// The kept rows of COND1, each of norm one, and with a peak force gamma_j <= peak for each pushing class.
SparseRows inequality_rows(const Reduction& reduction, bool peak) {
    std::vector<Triplet> entries;
    const Eigen::MatrixXi& rows = reduction.rows;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const double norm = rows.row(i).cast<double>().norm();
        for (Eigen::Index j = 0; j < rows.cols(); ++j) {
            if (rows(i, j) != 0) entries.emplace_back(static_cast<int>(i), static_cast<int>(j), rows(i, j) / norm);
        }
    }
    const int n = reduction.variables();
    auto count = static_cast<int>(rows.rows());
    for (int j = 0; peak && reduction.bounded && j < n; ++j, ++count) {
        entries.emplace_back(count, j, M_SQRT1_2);
        entries.emplace_back(count, n, -M_SQRT1_2);
    }
    SparseRows result(count, n + (peak ? 1 : 0));
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

void set_constraints(OrbitProgram& result, const Reduction& reduction, bool peak) {
    auto& program = result.program;
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    const Eigen::Index variables = n + (peak ? 1 : 0);
    result.orbit_variables = static_cast<int>(n);
    program.lower = Eigen::VectorXd::Zero(variables);
    if (!reduction.bounded) program.lower.head(n).setConstant(-no_bound);
    program.upper = Eigen::VectorXd::Constant(variables, no_bound);
    program.inequalities = inequality_rows(reduction, peak);
    program.inequality_values = Eigen::VectorXd::Zero(program.inequalities.rows());

    const Eigen::VectorXd contact = reduction.contact_row.cast<double>();
    const double norm = contact.norm();
    program.equalities.resize(norm > 0 ? 1 : 0, variables);
    program.equality_values = Eigen::VectorXd::Zero(program.equalities.rows());
    if (norm > 0) {
        for (Eigen::Index j = 0; j < n; ++j) program.equalities.insert(0, j) = contact[j] / norm;
        program.equality_values[0] = reduction.gap_sign / (norm * result.scale);
    }
    program.equalities.makeCompressed();
}

}  // namespace

Eigen::VectorXd OrbitProgram::gamma(const Eigen::VectorXd& x) const { return scale * x.head(orbit_variables); }

Eigen::VectorXd OrbitProgram::point(const Eigen::VectorXd& gamma) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(program.variables());
    x.head(orbit_variables) = gamma / scale;
    const bool peak = program.variables() > orbit_variables;
    if (peak && program.lower[0] == 0) x[orbit_variables] = std::max(x.maxCoeff(), 0.0);
    return x;
}

OrbitProgram orbit_program(const Reduction& reduction, const Kernel& kernel, Objective objective, double level,
                           const Eigen::VectorXd& reference) {
    if (is_extreme(objective)) {
        throw std::invalid_argument("objective: expected one at an energy level, got " + std::string(name(objective)));
    }
    if (!(level > 0) || !std::isfinite(level)) {
        throw std::invalid_argument("level: expected a finite number > 0, got " + std::to_string(level));
    }
    const int window = 2 * kernel.pattern.cells;
    if (objective == Objective::nearest) expect_size("reference", window, reference.size());
    OrbitProgram result;
    result.scale = std::sqrt(level / reduction.energy_factor);
    set_constraints(result, reduction, objective == Objective::least_force);
    auto& program = result.program;
    const auto variables = program.variables();
    program.gradient = Eigen::VectorXd::Zero(variables);
    program.hessian.resize(variables, variables);
    program.sphere_variables = result.orbit_variables;

    const auto wave = [&](int n) { return wave_term(reduction, kernel, n); };
    // In x, 2N sum b^2 over one window is `level` |x|^2; objectives are divided by `level`.
    const double unit = window * result.scale * result.scale / level;
    std::vector<Triplet> hessian;
    result.objective_unit = level;
    if (objective == Objective::least_shock) {
        for (int n = 0; n < kernel.pattern.period_steps(); ++n) add_square(hessian, unit, wave(n + 1), wave(n));
    } else if (objective == Objective::nearest) {
        const Eigen::VectorXd target = reference / result.scale;
        program.constant = unit * target.squaredNorm();
        for (int n = 0; n < window; ++n) {
            const Term term = wave(n);
            if (term.variable < 0) continue;
            hessian.emplace_back(term.variable, term.variable, 2.0 * unit);
            program.gradient[term.variable] -= 2.0 * unit * term.factor * target[n];
        }
    } else {
        program.gradient[variables - 1] = 1.0;
        result.objective_unit = window * result.scale;
    }
    program.hessian.setFromTriplets(hessian.begin(), hessian.end());
    return result;
}

double objective_of_waves(const Kernel& kernel, Objective objective, const Eigen::VectorXd& beta,
                          const Eigen::VectorXd& reference) {
    const int period = kernel.pattern.period_steps();
    const int window = 2 * kernel.pattern.cells;
    const auto wave = [&](int n) { return kernel.wave(beta, n); };
    double sum = 0;
    switch (objective) {
        case Objective::least_shock:
            for (int n = 0; n < period; ++n) sum += std::pow(wave(n + 1) - wave(n), 2);
            break;
        case Objective::nearest:
            for (int n = 0; n < window; ++n) sum += std::pow(wave(n) - reference[n], 2);
            break;
        case Objective::least_force:
            for (int n = kernel.pattern.free_steps; n < period; ++n) sum = std::max(sum, std::abs(wave(n)));
            break;
        default:
            for (int n = 0; n < window; ++n) sum += std::pow(wave(n), 2);
            break;
    }
    return window * sum;
}

}  // namespace nsma
