#include "least_squares.hpp"

#include <algorithm>

#include "decompositions.hpp"
#include "expect_size.hpp"
#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

class LawsonHanson {
public:
    LawsonHanson(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target, double tolerance)
        : matrix_(matrix),
          target_(target),
          tolerance_(tolerance),
          norms_(matrix.colwise().norm()),
          refused_(static_cast<std::size_t>(matrix.cols()), 0) {
        solution_.y = Eigen::VectorXd::Zero(matrix.cols());
        solution_.residual = target;
    }

    NonnegativeSolution run() {
        const auto iteration_limit = 10 * (matrix_.cols() + matrix_.rows()) + 100;
        for (Eigen::Index iteration = 0; iteration < iteration_limit && !solution_.converged; ++iteration) {
            stop_point();
            const int entering = entering_column();
            solution_.converged = entering < 0;
            if (!solution_.converged) enter(entering);
        }
        return std::move(solution_);
    }

private:
    [[nodiscard]] Eigen::VectorXd solve_on_support() const {
        return least_squares(matrix_(Eigen::all, solution_.support), target_);
    }

    // The column that the residual correlates with most; -1 at the solution.
    [[nodiscard]] int entering_column() const {
        const auto& support = solution_.support;
        const Eigen::VectorXd correlation = matrix_.transpose() * solution_.residual;
        const double residual_norm = solution_.residual.norm();
        int entering = -1;
        double best = 0;
        for (int j = 0; j < matrix_.cols(); ++j) {
            const bool open = refused_[static_cast<std::size_t>(j)] == 0 && norms_[j] > 0 &&
                              !std::binary_search(support.begin(), support.end(), j);
            if (!open || correlation[j] / norms_[j] <= best) continue;
            best = correlation[j] / norms_[j];
            entering = j;
        }
        const bool full_rank = static_cast<Eigen::Index>(support.size()) == matrix_.rows();
        const bool solved = best <= tolerance_ * residual_norm || residual_norm <= tolerance_ * target_.norm();
        return full_rank || solved ? -1 : entering;
    }

    void enter(int column) {
        auto& support = solution_.support;
        const auto place = support.insert(std::lower_bound(support.begin(), support.end(), column), column);
        Eigen::VectorXd trial = solve_on_support();
        if (!trial.allFinite() || trial[place - support.begin()] <= 0) {
            // Dependent on the support up to rounding: it cannot reduce the residual.
            support.erase(place);
            refused_[static_cast<std::size_t>(column)] = 1;
            return;
        }
        while (trial.size() > 0 && trial.minCoeff() <= 0) {
            leave_toward(trial);
            trial = support.empty() ? Eigen::VectorXd() : solve_on_support();
        }
        solution_.y.setZero();
        solution_.y(support) = trial;
        solution_.residual = target_;
        if (!support.empty()) solution_.residual -= matrix_(Eigen::all, support) * trial;
        std::fill(refused_.begin(), refused_.end(), char{0});
    }

    // As far from y toward the trial as all stay nonnegative; what comes to zero leaves the support.
    void leave_toward(const Eigen::VectorXd& trial) {
        const std::vector<int> support = std::move(solution_.support);
        double step = 1.0;
        for (std::size_t i = 0; i < support.size(); ++i) {
            const double now = solution_.y[support[i]];
            const double then = trial[static_cast<Eigen::Index>(i)];
            if (then <= 0) step = std::min(step, now / (now - then));
        }
        solution_.support.clear();
        for (std::size_t i = 0; i < support.size(); ++i) {
            const double then = trial[static_cast<Eigen::Index>(i)];
            double& y = solution_.y[support[i]];
            const bool blocks = then <= 0 && y / (y - then) <= step;
            y += step * (then - y);
            if (blocks || y <= 0) {
                y = 0;
            } else {
                solution_.support.push_back(support[i]);
            }
        }
    }

    const Eigen::MatrixXd& matrix_;
    const Eigen::VectorXd& target_;
    double tolerance_;
    Eigen::VectorXd norms_;
    std::vector<char> refused_;
    NonnegativeSolution solution_;
};

}  // namespace

NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target,
                                              double tolerance) {
    expect_size("target", matrix.rows(), target.size());
    return LawsonHanson(matrix, target, tolerance).run();
}

}  // namespace nsma
