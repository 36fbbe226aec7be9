#pragma once

#include <string_view>

#include <Eigen/Core>

#include "nsma/wave/bar.hpp"
#include "nsma/orbit/pattern.hpp"

namespace nsma {

/// Ways to the kernel of S_T = A_c^p A_f^r - I.
enum class KernelMethod {
    exact_cycles,       ///< the program's own: walks cycles, integers only
    dense_svd,          ///< singular vectors of S_T by Jacobi rotations, zero up to the tolerance
    rank_revealing_qr,  ///< pivoted QR of the transpose of S_T, rank by the tolerance
    matrix_powers       ///< limit of ((I + A_c^p A_f^r)/2)^(2^k): the projector on the kernel,
                        ///< since the steps are orthogonal in the energy norm
};
[[nodiscard]] std::string_view name(KernelMethod method);

/// Orthonormal basis of ker S_T, 2N x m' in the coordinates [sigma/z; v]. `tolerance` > 0 is
/// relative to max(1, the largest) singular value or pivot; for the matrix powers it bounds the
/// change of the last squaring. Not used by the exact cycles. Source: [1] Eq. (4).
[[nodiscard]] Eigen::MatrixXd kernel_space(KernelMethod method, const Bar& bar, const Pattern& pattern,
                                           double tolerance = 1e-9);

/// Number of singular values or pivots (QR) of S_T that each tolerance calls zero:
/// the dimension that the method would find. One factorisation serves all.
[[nodiscard]] Eigen::VectorXi dimensions_found(KernelMethod method, const Bar& bar, const Pattern& pattern,
                                               const Eigen::VectorXd& tolerances);

/// Spectral distance of the spaces two orthonormal bases span: sine of the largest angle, 1 where
/// their dimensions differ, 0 for two empty ones.
[[nodiscard]] double space_distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace nsma
