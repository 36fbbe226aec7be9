#pragma once

#include <cmath>

#include "nsma/orbit/orbit.hpp"

namespace nsma {

/// b_n dt/u over one period of the pattern, size n_T.
[[nodiscard]] inline Eigen::VectorXd motion_waves(const Orbit& orbit) {
    Eigen::VectorXd waves(orbit.kernel.pattern.period_steps());
    for (int n = 0; n < waves.size(); ++n) {
        const int column = orbit.kernel.column(n);
        waves[n] = column >= 0 ? orbit.kernel.sign[static_cast<std::size_t>(n)] * orbit.beta[column] : 0.0;
    }
    return waves;
}

/// Smallest divisor of the period that shifts b_n onto itself within `tolerance`.
[[nodiscard]] inline int minimal_period(const Eigen::VectorXd& waves, double tolerance) {
    const int period = static_cast<int>(waves.size());
    for (int shift = 1; shift <= period / 2; ++shift) {
        if (period % shift != 0) continue;
        bool repeats = true;
        for (int n = 0; repeats && n + shift < period; ++n)
            repeats = std::abs(waves[n + shift] - waves[n]) <= tolerance;
        if (repeats) return shift;
    }
    return period;
}

}  // namespace nsma
