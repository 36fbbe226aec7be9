#include "nsma/orbit/conditions.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "gap_sign.hpp"
#include "index.hpp"

namespace nsma {

double Conditions::energy_factor() const {
    const double cells = kernel.pattern.cells;
    return 4.0 * cells * cells / kernel.classes;
}

Conditions conditions(const Kernel& kernel, int gap_sign) {
    validate_gap_sign(gap_sign);
    using Sign = Conditions::Sign;
    Conditions result;
    result.kernel = kernel;
    result.gap_sign = gap_sign;
    result.bound_of.assign(index(kernel.dimension()), Sign::free);
    const Pattern& pattern = kernel.pattern;
    kernel.for_each_live(pattern.free_steps, pattern.period_steps(), [&](int, std::size_t column, int sign) {
        const Sign wanted = sign > 0 ? Sign::nonnegative : Sign::nonpositive;
        Sign& bound = result.bound_of[column];
        if (bound == Sign::free) {
            bound = wanted;
        } else if (bound != wanted) {
            bound = Sign::zero;
        }
    });
    return result;
}

Eigen::VectorXi contact_row(const Kernel& kernel) {
    const int period = kernel.pattern.period_steps();
    const int window = 2 * kernel.pattern.cells;
    const int rounds = window / period;     // whole periods in the queue
    const int remainder = window % period;  // steps seen once more
    Eigen::VectorXi row = Eigen::VectorXi::Zero(kernel.dimension());
    const int last = rounds > 0 ? period : remainder;
    kernel.for_each_live(0, last, [&](int n, std::size_t column, int sign) {
        row[static_cast<Eigen::Index>(column)] -= sign * (rounds + (n < remainder ? 1 : 0));
    });
    return row;
}

Eigen::MatrixXi tip_rows(const Kernel& kernel) {
    const int period = kernel.pattern.period_steps();
    Eigen::MatrixXi rows(period + 1, kernel.dimension());
    rows.row(0) = contact_row(kernel).transpose();
    for (int n = 0; n < period; ++n) {
        rows.row(n + 1) = rows.row(n);
        const int column = kernel.column(n);
        if (n < kernel.pattern.free_steps && column >= 0) {
            rows(n + 1, column) += 2 * kernel.sign[index(n)];
        }
    }
    return rows;
}

Eigen::VectorXd tip_history(const Kernel& kernel, const Eigen::VectorXd& beta) {
    if (beta.size() != kernel.dimension()) {
        throw std::invalid_argument(fmt::format("beta: expected size {}, got {}", kernel.dimension(), beta.size()));
    }
    const int period = kernel.pattern.period_steps();
    const int free_steps = kernel.pattern.free_steps;
    const double contact = contact_row(kernel).cast<double>().dot(beta);
    Eigen::VectorXd history(period + 1);
    history[0] = contact;
    for (int n = 0; n + 1 < free_steps; ++n) {
        history[n + 1] = history[n] + 2.0 * kernel.wave(beta, n);
    }
    history.tail(period + 1 - free_steps).setConstant(contact);  // n = r..n_T
    return history;
}

}  // namespace nsma
