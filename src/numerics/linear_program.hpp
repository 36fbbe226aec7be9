#pragma once

#include <limits>
#include <memory>
#include <string>

#include <Eigen/Core>

namespace nsma {

inline constexpr double no_bound = std::numeric_limits<double>::infinity();

/// minimise cost . x subject to row_lower <= rows x <= row_upper and lower <= x <= upper.
struct LinearProgram {
    Eigen::MatrixXd rows;  ///< R x n
    Eigen::VectorXd row_lower;
    Eigen::VectorXd row_upper;
    Eigen::VectorXd lower;
    Eigen::VectorXd upper;
};

enum class LinearStatus { optimal, infeasible, unbounded, failed };

struct LinearSolution {
    LinearStatus status = LinearStatus::failed;
    Eigen::VectorXd x;         ///< optimal point, size n
    Eigen::VectorXd row_dual;  ///< optimal: multipliers of the rows, size R
    double value = 0;
};

/// Simplex method of CLP on one feasible set with changing costs: each solve starts from the
/// basis of the last one.
class LinearSolver {
public:
    /// Throws std::invalid_argument on a size mismatch.
    explicit LinearSolver(const LinearProgram& program);
    ~LinearSolver();
    LinearSolver(LinearSolver&&) noexcept;
    LinearSolver& operator=(LinearSolver&&) noexcept;

    [[nodiscard]] LinearSolution minimise(const Eigen::VectorXd& cost);

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Version of CLP in use, e.g. "1.17.6".
[[nodiscard]] std::string clp_version();

}  // namespace nsma
