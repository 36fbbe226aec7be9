#pragma once

#include <Eigen/Core>

#include "nsma/wave/mesh.hpp"
#include "nsma/orbit/pattern.hpp"

namespace nsma::dense {

/// Orthonormal basis (2N x m, energy norm after scaling stresses by 1/z) of ker S_T from the
/// singular value decomposition of the literal matrix. Reference for nsma::exact_kernel.
/// Coordinates [sigma/z; v]. Singular values up to `tolerance` times max(1, the largest) are zero:
/// they lie in [0, 2], and S_T itself may vanish. Source: [1] Eq. (4).
[[nodiscard]] Eigen::MatrixXd svd_kernel(const Bar& bar, const Pattern& pattern, double tolerance = 1e-9);

}  // namespace nsma::dense
