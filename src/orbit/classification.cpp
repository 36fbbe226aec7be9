#include "nsma/orbit/classification.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "minimal_period.hpp"
#include "nsma/orbit/conditions.hpp"

namespace nsma {

Classification classify(const Orbit& orbit, double tolerance) {
    if (!std::isfinite(tolerance) || tolerance < 0.0) {
        throw std::invalid_argument(fmt::format("tolerance: expected a finite value >= 0, got {}", tolerance));
    }
    const Kernel& kernel = orbit.kernel;
    const Pattern& pattern = kernel.pattern;
    const int period = pattern.period_steps();
    const Eigen::VectorXd waves = orbit.kernel.waves(orbit.beta);
    const double silence = tolerance * waves.cwiseAbs().maxCoeff();
    const Eigen::VectorXd tip = tip_history(kernel, orbit.beta);
    const int gap_sign = orbit.bar.gap_sign();
    const double touch = tolerance * (gap_sign != 0 ? 1.0 : tip.cwiseAbs().maxCoeff());

    Classification result;
    result.tolerance = tolerance;
    result.minimal_period_steps = minimal_period(waves, silence);
    for (int n = pattern.free_steps; n < period; ++n) {
        result.silent_contact_steps += std::abs(waves[n]) <= silence;
    }
    for (int n = 1; n < pattern.free_steps; ++n) {
        result.wall_touches += std::abs(tip[n] - gap_sign) <= touch;
    }
    result.forceless = result.silent_contact_steps == pattern.contact_steps;
    result.full_support = kernel.dimension() > 0 && orbit.beta.cwiseAbs().minCoeff() > silence;
    if (const auto motion = least_label(orbit, tolerance)) {
        const MotionLabel& label = motion->label;
        const bool own = label.free_steps == pattern.free_steps && label.contact_steps == pattern.contact_steps &&
                         label.shift_steps == 0;
        if (!own) result.same_motion_as = label;
    }
    return result;
}

}  // namespace nsma
