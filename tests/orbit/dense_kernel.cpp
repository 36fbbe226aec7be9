#include "dense_kernel.hpp"

#include <algorithm>

#include <Eigen/SVD>

#include "wave/dense_wfem.hpp"

namespace nsma::dense {

Eigen::MatrixXd svd_kernel(const Bar& bar, const Pattern& pattern, double tolerance) {
    validate(pattern);
    const int cells = pattern.cells;
    const double z = bar.impedance();
    Eigen::MatrixXd matrix = periodicity_matrix(bar, Mesh{cells}, pattern.free_steps, pattern.contact_steps);
    // In the coordinates [sigma/z; v] the steps are orthogonal: no unit spoils the ranks.
    matrix.topRightCorner(cells, cells) /= z;
    matrix.bottomLeftCorner(cells, cells) *= z;

    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullV);
    const Eigen::VectorXd& values = svd.singularValues();
    const double threshold = tolerance * std::max(1.0, values[0]);
    Eigen::Index rank = 0;
    while (rank < values.size() && values[rank] > threshold) {
        ++rank;
    }
    return svd.matrixV().rightCols(values.size() - rank);
}

}  // namespace nsma::dense
