#include "nsma/orbit/physical_values.hpp"

#include <cmath>

namespace nsma {

PhysicalValues physical_values(const Orbit& orbit) {
    const Pattern& pattern = orbit.kernel.pattern;
    const Eigen::VectorXd waves = orbit.kernel.waves(amplitudes(orbit));
    const double largest = waves.cwiseAbs().maxCoeff();
    PhysicalValues values;
    values.frequency = 1.0 / period(orbit);
    const double contact = waves.tail(pattern.contact_steps).maxCoeff();
    values.peak_force = 2.0 * orbit.bar.impedance() * orbit.bar.area * std::max(contact, 0.0);
    // At a free end the wave that arrives moves the tip at twice its own velocity.
    for (int n = pattern.free_steps - 1; n >= 0 && values.impact_speed == 0; --n) {
        if (std::abs(waves[n]) > 1e-9 * largest) values.impact_speed = 2.0 * std::abs(waves[n]);
    }
    // Stress is the sum of two waves on their way; at the fixed end every wave meets itself.
    values.peak_stress = 2.0 * orbit.bar.impedance() * largest;
    values.tip_least = tip_displacement(orbit).minCoeff();
    return values;
}

}  // namespace nsma
