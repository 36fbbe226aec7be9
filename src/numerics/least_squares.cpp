#include "least_squares.hpp"

#include <algorithm>
#include <stdexcept>

#include "decompositions.hpp"

namespace nsma {
NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target,
                                              double tolerance) {
    if (matrix.rows() != target.size()) {
        throw std::invalid_argument("target: expected size " + std::to_string(matrix.rows()) + ", got " +
                                    std::to_string(target.size()));
    }
    const auto columns = matrix.cols();
    NonnegativeSolution solution;
    solution.y = Eigen::VectorXd::Zero(columns);
    solution.residual = target;
    const Eigen::VectorXd norms = matrix.colwise().norm();
    std::vector<char> passive(static_cast<std::size_t>(columns), 0);
    std::vector<char> refused(static_cast<std::size_t>(columns), 0);
    auto& support = solution.support;
    const auto iteration_limit = 10 * (columns + matrix.rows()) + 100;

    for (Eigen::Index iteration = 0; iteration < iteration_limit; ++iteration) {
        const Eigen::VectorXd correlation = matrix.transpose() * solution.residual;
        const double residual_norm = solution.residual.norm();
        Eigen::Index entering = -1;
        double best = 0;
        for (Eigen::Index j = 0; j < columns; ++j) {
            const auto k = static_cast<std::size_t>(j);
            if (passive[k] != 0 || refused[k] != 0 || norms[j] <= 0) continue;
            const double score = correlation[j] / norms[j];
            if (score > best) {
                best = score;
                entering = j;
            }
        }
        const bool full_rank = static_cast<Eigen::Index>(support.size()) == matrix.rows();
        if (entering < 0 || best <= tolerance * residual_norm || residual_norm <= tolerance * target.norm() ||
            full_rank) {
            solution.converged = true;
            break;
        }
        passive[static_cast<std::size_t>(entering)] = 1;
        support.insert(std::lower_bound(support.begin(), support.end(), static_cast<int>(entering)),
                       static_cast<int>(entering));
        Eigen::VectorXd trial = least_squares(matrix(Eigen::all, support), target);
        const auto position = static_cast<Eigen::Index>(
            std::lower_bound(support.begin(), support.end(), static_cast<int>(entering)) - support.begin());
        if (!trial.allFinite() || trial[position] <= 0) {
            // Dependent on the support up to rounding: it cannot reduce the residual.
            support.erase(support.begin() + position);
            passive[static_cast<std::size_t>(entering)] = 0;
            refused[static_cast<std::size_t>(entering)] = 1;
            continue;
        }
        while (trial.minCoeff() <= 0) {
            double step = 1.0;
            for (std::size_t i = 0; i < support.size(); ++i) {
                const double now = solution.y[support[i]];
                const double then = trial[static_cast<Eigen::Index>(i)];
                if (then <= 0) step = std::min(step, now / (now - then));
            }
            std::vector<int> remaining;
            for (std::size_t i = 0; i < support.size(); ++i) {
                const int j = support[i];
                const double then = trial[static_cast<Eigen::Index>(i)];
                double& y = solution.y[j];
                const bool blocks = then <= 0 && y / (y - then) <= step;
                y += step * (then - y);
                if (blocks || y <= 0) {
                    y = 0;
                    passive[static_cast<std::size_t>(j)] = 0;
                } else {
                    remaining.push_back(j);
                }
            }
            support = std::move(remaining);
            if (support.empty()) break;
            trial = least_squares(matrix(Eigen::all, support), target);
        }
        solution.y.setZero();
        for (std::size_t i = 0; i < support.size(); ++i) {
            solution.y[support[i]] = trial[static_cast<Eigen::Index>(i)];
        }
        solution.residual = target;
        if (!support.empty()) solution.residual -= matrix(Eigen::all, support) * trial;
        std::fill(refused.begin(), refused.end(), char{0});
    }
    return solution;
}

}  // namespace nsma
