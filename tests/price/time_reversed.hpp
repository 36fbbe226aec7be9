#pragma once

#include <Eigen/Core>

#include "nsma/orbit/kernel.hpp"

// The amplitudes of the motion run backward, of the same pattern: a wave changes its sign with the free step it arrives
// in.
inline Eigen::VectorXd time_reversed(const nsma::Kernel& kernel, const Eigen::VectorXd& beta) {
    const int r = kernel.pattern.free_steps;
    const int steps = kernel.pattern.period_steps();
    Eigen::VectorXd result = Eigen::VectorXd::Zero(beta.size());
    for (int n = 0; n < steps; ++n) {
        const int column = kernel.column(n);
        if (column < 0) continue;
        const int source = n < r ? r - 1 - n : steps + r - 1 - n;
        const int from = kernel.column(source);
        const double wave = from < 0 ? 0.0 : kernel.sign[static_cast<std::size_t>(source)] * beta[from];
        result[column] = (n < r ? -wave : wave) * kernel.sign[static_cast<std::size_t>(n)];
    }
    return result;
}
