#include "nsma/orbit/classification.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "nsma/orbit/conditions.hpp"

namespace nsma {

namespace {

/// Smallest divisor of the period that shifts b_n onto itself within `tolerance`.
int minimal_period(const Eigen::VectorXd& waves, double tolerance) {
    const int period = static_cast<int>(waves.size());
    for (int shift = 1; shift <= period / 2; ++shift) {
        if (period % shift != 0) {
            continue;
        }
        bool repeats = true;
        for (int n = 0; repeats && n + shift < period; ++n) {
            repeats = std::abs(waves[n + shift] - waves[n]) <= tolerance;
        }
        if (repeats) {
            return shift;
        }
    }
    return period;
}

}  // namespace

Classification classify(const Orbit& orbit, double tolerance) {
    if (!std::isfinite(tolerance) || tolerance < 0.0) {
        throw std::invalid_argument(
            fmt::format("tolerance: expected a finite value >= 0, got {}", tolerance));
    }
    const Kernel& kernel = orbit.kernel;
    const Pattern& pattern = kernel.pattern;
    const int period = pattern.period_steps();
    Eigen::VectorXd waves(period);  // b_n dt/u
    for (int n = 0; n < period; ++n) {
        const int column = kernel.column(n);
        waves[n] =
            column >= 0 ? kernel.sign[static_cast<std::size_t>(n)] * orbit.beta[column] : 0.0;
    }
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
    result.full_support = kernel.dimension() > 0 && orbit.beta.cwiseAbs().minCoeff() > silence;
    return result;
}

}  // namespace nsma
