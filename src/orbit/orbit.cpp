#include "nsma/orbit/orbit.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "nsma/orbit/conditions.hpp"

namespace nsma {

Orbit make_orbit(const Bar& bar, const Kernel& kernel, const Eigen::VectorXd& beta) {
    validate(bar);
    validate(kernel.pattern);
    if (beta.size() != kernel.dimension()) {
        throw std::invalid_argument(fmt::format("beta: expected size {}, got {}", kernel.dimension(), beta.size()));
    }
    for (Eigen::Index i = 0; i < beta.size(); ++i) {
        if (!std::isfinite(beta[i])) {
            throw std::invalid_argument(fmt::format("beta: expected finite values, got {} at entry {}", beta[i], i));
        }
    }
    return {bar, kernel, beta};
}

Eigen::VectorXd amplitudes(const Orbit& orbit) {
    return orbit.beta * (orbit.bar.displacement_unit() / orbit.mesh().time_step(orbit.bar));
}

State initial_state(const Orbit& orbit) {
    const int cells = orbit.kernel.pattern.cells;
    const int period = orbit.kernel.pattern.period_steps();
    const double z = orbit.bar.impedance();
    const Eigen::VectorXd b = orbit.kernel.waves(amplitudes(orbit));
    State state(2 * cells);
    for (int i = 1; i <= cells; ++i) {
        const double toward = b[(cells - i) % period];
        const double away = b[(cells + i - 1) % period];
        state[i - 1] = -z * (toward + away);
        state[cells + i - 1] = toward - away;
    }
    return state;
}

double period(const Orbit& orbit) { return orbit.kernel.pattern.period_steps() * orbit.mesh().time_step(orbit.bar); }

double energy(const Orbit& orbit) { return energy_ratio(orbit) * orbit.bar.energy_unit(); }

double energy_ratio(const Orbit& orbit) {
    const double cells = orbit.kernel.pattern.cells;
    return 4.0 * cells * cells / orbit.kernel.classes * orbit.beta.squaredNorm();
}

Eigen::VectorXd tip_displacement(const Orbit& orbit) {
    return orbit.bar.displacement_unit() * tip_history(orbit.kernel, orbit.beta);
}

Eigen::VectorXd contact_force(const Orbit& orbit) {
    const int free_steps = orbit.kernel.pattern.free_steps;
    const int contact_steps = orbit.kernel.pattern.contact_steps;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(free_steps + contact_steps);
    const Eigen::VectorXd b = orbit.kernel.waves(amplitudes(orbit));
    force.tail(contact_steps) = (-2.0 * orbit.bar.impedance() * orbit.bar.area) * b.tail(contact_steps);
    return force;
}

Field field(const Orbit& orbit) {
    const int cells = orbit.kernel.pattern.cells;
    const int period = orbit.kernel.pattern.period_steps();
    const double z = orbit.bar.impedance();
    const Eigen::VectorXd b = orbit.kernel.waves(amplitudes(orbit));
    Field result{Eigen::MatrixXd(cells, period), Eigen::MatrixXd(cells, period)};
    for (int n = 0; n < period; ++n) {
        for (int i = 1; i <= cells; ++i) {
            const double toward = b[(n + cells - i) % period];
            const double away = b[(n + cells + i - 1) % period];
            result.stress(i - 1, n) = -z * (toward + away);
            result.velocity(i - 1, n) = toward - away;
        }
    }
    return result;
}

}  // namespace nsma
