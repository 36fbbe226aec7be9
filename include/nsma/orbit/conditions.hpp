#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "nsma/orbit/kernel.hpp"

namespace nsma {

/// COND1-3 of [1] and the energy, over the nondimensional amplitudes beta = alpha dt/u with u
/// the displacement unit of the bar. All coefficients are integers, so four integers
/// (N, r, p, delta) are the whole problem.
///
///   COND1: x_n . beta <= delta,  n = 0..r          (rows of `tip_rows`)
///   COND2: x_0 . beta  = delta   (rows 0 and r..n_T are the same row)
///   COND3: eps_n beta_{class(n)} >= 0, n = r..n_T-1  (bounds: `bound_of`)
///   E/E_unit = energy_factor * |beta|^2, energy_factor = 4 N^2/g
struct Conditions {
    /// Which values of one amplitude COND3 allows.
    enum class Sign : std::uint8_t {
        free,         ///< any: no contact step carries it
        nonnegative,  ///< >= 0
        nonpositive,  ///< <= 0
        zero          ///< 0 alone: bounded from both sides
    };

    Kernel kernel;               ///< of the pattern
    int gap_sign = 1;            ///< delta
    std::vector<Sign> bound_of;  ///< COND3 per column; size m

    [[nodiscard]] int dimension() const { return kernel.dimension(); }  ///< m, the size of beta
    [[nodiscard]] double energy_factor() const;                         ///< 4 N^2/g
};

/// Reads the signs of COND3 off the kernel, O(n_T). Throws std::invalid_argument on a gap sign other than -1, 0, 1.
[[nodiscard]] Conditions conditions(const Kernel& kernel, int gap_sign);

/// Row x_0 of the tip displacement over beta (size m, integers): COND2's only row.
[[nodiscard]] Eigen::VectorXi contact_row(const Kernel& kernel);

/// All rows x_0..x_{n_T} (n_T + 1 x m integers): row n+1 = row n + 2 eps_n e_{class(n)} in free
/// flight, unchanged in contact.
[[nodiscard]] Eigen::MatrixXi tip_rows(const Kernel& kernel);

/// Tip displacement x_n/u for n = 0..n_T from beta, O(N + n_T), no matrix formed.
[[nodiscard]] Eigen::VectorXd tip_history(const Kernel& kernel, const Eigen::VectorXd& beta);

}  // namespace nsma
