#pragma once

#include <Eigen/Core>

#include "nsma/wave/state.hpp"
#include "nsma/orbit/kernel.hpp"

namespace nsma {

/// One periodic motion: a bar, its kernel and the nondimensional amplitudes beta.
/// Source: [1] Eq. (5).
struct Orbit {
    Bar bar;               ///< its gap sets the unit u of beta
    Kernel kernel;         ///< of the pattern; m amplitudes
    Eigen::VectorXd beta;  ///< size m, nondimensional; alpha = beta u/dt

    [[nodiscard]] Mesh mesh() const { return Mesh{kernel.pattern.cells}; }  ///< that of the pattern
};

/// Throws std::invalid_argument unless the bar is valid and beta has size m and is finite.
[[nodiscard]] Orbit make_orbit(const Bar& bar, const Kernel& kernel, const Eigen::VectorXd& beta);

[[nodiscard]] Eigen::VectorXd amplitudes(const Orbit& orbit);        ///< alpha [m/s], size m
[[nodiscard]] State initial_state(const Orbit& orbit);               ///< Q0, size 2N
[[nodiscard]] double period(const Orbit& orbit);                     ///< T [s]
[[nodiscard]] double energy(const Orbit& orbit);                     ///< E [J]
[[nodiscard]] double energy_ratio(const Orbit& orbit);               ///< E/energy unit of the bar
[[nodiscard]] Eigen::VectorXd tip_displacement(const Orbit& orbit);  ///< x_n [m], n = 0..n_T
[[nodiscard]] Eigen::VectorXd contact_force(const Orbit& orbit);     ///< lambda_n [N], n = 0..n_T-1

/// Space-time field over one period: stress and velocity of each cell (N x n_T), column n is
/// time step n, row i cell i + 1 counted from the fixed end.
struct Field {
    Eigen::MatrixXd stress;    ///< [Pa]
    Eigen::MatrixXd velocity;  ///< [m/s]
};
/// The field from the waves on their way, O(N n_T): sigma = -z (b_{n+N-i} + b_{n+N+i-1}), v their difference.
[[nodiscard]] Field field(const Orbit& orbit);

}  // namespace nsma
