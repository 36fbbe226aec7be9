#pragma once

#include <Eigen/Core>

#include "nsma/wave/state.hpp"

namespace nsma::dense {

/// Literal step matrices of the Wave Finite Element Method, 2N x 2N. Reference only: the
/// program itself moves waves through nsma::WaveQueue and never forms a matrix.

/// A_f: one step with a free contact end (zero stress there). Source: [1] Eq. (1).
[[nodiscard]] Eigen::MatrixXd free_step_matrix(const Bar& bar, const Mesh& mesh);

/// A_c: one step with the contact end at rest against the wall. Source: [1] Eq. (3).
[[nodiscard]] Eigen::MatrixXd contact_step_matrix(const Bar& bar, const Mesh& mesh);

/// S_T = A_c^p A_f^r - I. Source: [1] Eq. (4). Throws std::invalid_argument unless r, p >= 1.
[[nodiscard]] Eigen::MatrixXd periodicity_matrix(const Bar& bar, const Mesh& mesh, int free_steps, int contact_steps);

/// One step in place, cell by cell from the interface values, O(N). `contact` chooses the
/// condition at the contact end. Source: [2], the scheme behind [1] Eq. (1).
void cell_step(const Bar& bar, const Mesh& mesh, bool contact, State& state);

}  // namespace nsma::dense
