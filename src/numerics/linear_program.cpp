#include "linear_program.hpp"

#include <algorithm>
#include <string>

#include <coin/ClpConfig.h>
#include <coin/ClpSimplex.hpp>
#include <coin/CoinPackedVector.hpp>

#include "expect_size.hpp"

namespace nsma {

struct LinearSolver::Implementation {
    ClpSimplex simplex;
    Eigen::Index rows = 0;
    Eigen::Index variables = 0;
    bool started = false;
};

namespace {

double clp_bound(double bound) {
    if (bound == no_bound) return COIN_DBL_MAX;
    if (bound == -no_bound) return -COIN_DBL_MAX;
    return bound;
}

}  // namespace

LinearSolver::LinearSolver(const LinearProgram& program) : implementation_(std::make_unique<Implementation>()) {
    const auto n = program.rows.cols();
    const auto count = program.rows.rows();
    expect_size("row_lower", count, program.row_lower.size());
    expect_size("row_upper", count, program.row_upper.size());
    expect_size("lower", n, program.lower.size());
    expect_size("upper", n, program.upper.size());
    implementation_->rows = count;
    implementation_->variables = n;

    auto& simplex = implementation_->simplex;
    simplex.setLogLevel(0);
    simplex.setPrimalTolerance(1e-9);
    simplex.setDualTolerance(1e-9);
    CoinPackedMatrix matrix(true, 0, 0);
    // CLP crashes on a program without rows: it gets one that holds always.
    matrix.setDimensions(static_cast<int>(std::max<Eigen::Index>(count, 1)), 0);
    for (Eigen::Index j = 0; j < n; ++j) {
        CoinPackedVector entries;
        for (Eigen::Index i = 0; i < count; ++i) {
            if (program.rows(i, j) != 0) entries.insert(static_cast<int>(i), program.rows(i, j));
        }
        matrix.appendCol(entries);
    }
    const auto clp_bounds = [](const Eigen::VectorXd& bounds) {
        Eigen::VectorXd result = bounds;
        for (auto& bound : result) bound = clp_bound(bound);
        return result;
    };
    const Eigen::VectorXd lower = clp_bounds(program.lower);
    const Eigen::VectorXd upper = clp_bounds(program.upper);
    const Eigen::VectorXd none = Eigen::VectorXd::Constant(1, no_bound);
    const Eigen::VectorXd row_lower = clp_bounds(count > 0 ? program.row_lower : Eigen::VectorXd(-none));
    const Eigen::VectorXd row_upper = clp_bounds(count > 0 ? program.row_upper : none);
    const Eigen::VectorXd cost = Eigen::VectorXd::Zero(n);
    simplex.loadProblem(matrix, lower.data(), upper.data(), cost.data(), row_lower.data(), row_upper.data());
}

LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
LinearSolver& LinearSolver::operator=(LinearSolver&&) noexcept = default;

LinearSolution LinearSolver::minimise(const Eigen::VectorXd& cost) {
    auto& simplex = implementation_->simplex;
    expect_size("cost", implementation_->variables, cost.size());
    for (Eigen::Index j = 0; j < cost.size(); ++j) {
        simplex.setObjectiveCoefficient(static_cast<int>(j), cost[j]);
    }
    // A new cost keeps the last basis primal feasible, so the primal method goes on from it.
    if (implementation_->started) {
        simplex.primal(1);
    } else {
        simplex.initialSolve();
        implementation_->started = true;
    }
    LinearSolution solution;
    const int status = simplex.status();
    if (status == 1) {
        solution.status = LinearStatus::infeasible;
        return solution;
    }
    if (status == 2) {
        solution.status = LinearStatus::unbounded;
        return solution;
    }
    if (status != 0) return solution;
    solution.status = LinearStatus::optimal;
    solution.x = Eigen::Map<const Eigen::VectorXd>(simplex.primalColumnSolution(), implementation_->variables);
    solution.row_dual = Eigen::Map<const Eigen::VectorXd>(simplex.dualRowSolution(), implementation_->rows);
    solution.value = cost.dot(solution.x);
    return solution;
}

std::string clp_version() { return CLP_VERSION; }

}  // namespace nsma
