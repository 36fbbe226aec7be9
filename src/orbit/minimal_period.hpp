#pragma once

#include <cmath>

#include <Eigen/Core>

namespace nsma {

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
