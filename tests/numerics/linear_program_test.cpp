#include "numerics/linear_program.hpp"

#include "numerics/least_squares.hpp"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using nsma::LinearProgram;
using nsma::LinearSolver;
using nsma::LinearStatus;
using nsma::no_bound;

constexpr double clp_tolerance = 1e-8;  // CLP is asked for 1e-9 in both feasibilities

/// max 3x + 5y, x <= 4, 2y <= 12, 3x + 2y <= 18, x, y >= 0 (Hillier and Lieberman): 36 at (2, 6).
LinearProgram wyndor() {
    LinearProgram program;
    program.rows.resize(3, 2);
    program.rows << 1, 0, 0, 2, 3, 2;
    program.row_lower = VectorXd::Constant(3, -no_bound);
    program.row_upper = Eigen::Vector3d(4, 12, 18);
    program.lower = Vector2d(0, 0);
    program.upper = Vector2d(no_bound, no_bound);
    return program;
}

/// {r x <= 0, w x = 1, x >= 0}, w the last row, is empty if and only if w is a nonnegative sum of the r and -x >= 0.
bool infeasible_by_projection(const LinearProgram& program) {
    const Eigen::Index rows = program.rows.rows() - 1, columns = program.rows.cols();
    MatrixXd normals(columns, rows + columns);
    normals << program.rows.topRows(rows).transpose(), -MatrixXd::Identity(columns, columns);
    const VectorXd w = program.rows.row(rows).transpose();
    return nsma::nonnegative_least_squares(normals, w).residual.norm() <= 1e-9 * (1 + w.norm());
}

TEST(LinearSolver, TextbookOptimumAndDuals) {
    LinearSolver solver(wyndor());
    const auto solution = solver.minimise(Vector2d(-3, -5));
    ASSERT_EQ(solution.status, LinearStatus::optimal);
    EXPECT_NEAR(solution.value, -36, clp_tolerance);
    EXPECT_NEAR(solution.x[0], 2, clp_tolerance);
    EXPECT_NEAR(solution.x[1], 6, clp_tolerance);
    // Shadow prices 0, 3/2 and 1 of the maximum, so minus these here.
    EXPECT_NEAR(solution.row_dual[0], 0, clp_tolerance);
    EXPECT_NEAR(solution.row_dual[1], -1.5, clp_tolerance);
    EXPECT_NEAR(solution.row_dual[2], -1, clp_tolerance);
}

TEST(LinearSolver, CostsMayChange) {
    LinearSolver solver(wyndor());
    EXPECT_NEAR(solver.minimise(Vector2d(-3, -5)).value, -36, clp_tolerance);
    EXPECT_NEAR(solver.minimise(Vector2d(-1, 0)).value, -4, clp_tolerance);
    EXPECT_NEAR(solver.minimise(Vector2d(1, 1)).value, 0, clp_tolerance);
    EXPECT_NEAR(solver.minimise(Vector2d(-3, -5)).value, -36, clp_tolerance);
}

TEST(LinearSolver, UnboundedIsSaidAndLeavesTheSolverUsable) {
    LinearProgram program = wyndor();
    program.row_upper.setConstant(no_bound);
    LinearSolver solver(program);
    EXPECT_EQ(solver.minimise(Vector2d(-1, 0)).status, LinearStatus::unbounded);
    const auto solution = solver.minimise(Vector2d(1, 2));
    ASSERT_EQ(solution.status, LinearStatus::optimal);
    EXPECT_NEAR(solution.value, 0, clp_tolerance);
}

TEST(LinearSolver, InfeasibleIsSaid) {
    LinearProgram program = wyndor();
    program.row_lower[2] = 18;  // 3x + 2y = 18 with x <= 1 and y <= 2
    program.upper = Vector2d(1, 2);
    LinearSolver solver(program);
    const auto solution = solver.minimise(Vector2d(0, 0));
    ASSERT_EQ(solution.status, LinearStatus::infeasible);
}

TEST(LinearSolver, RandomConesAreJudgedAsByLeastSquares) {
    // Small-integer rows r x <= 0 and w x = 1 over x >= 0, as the patterns have them.
    std::mt19937 random(7);
    std::uniform_int_distribution<int> draw(-2, 2);
    int infeasible = 0;
    for (int trial = 0; trial < 200; ++trial) {
        LinearProgram program;
        program.rows = MatrixXd::NullaryExpr(5, 4, [&](Eigen::Index, Eigen::Index) { return draw(random); });
        program.row_lower = VectorXd::Constant(5, -no_bound);
        program.row_upper = VectorXd::Zero(5);
        program.row_lower[4] = program.row_upper[4] = 1;
        program.lower = VectorXd::Zero(4);
        program.upper = VectorXd::Constant(4, no_bound);
        LinearSolver solver(program);
        const auto solution = solver.minimise(VectorXd::Zero(4));
        EXPECT_EQ(solution.status == LinearStatus::infeasible, infeasible_by_projection(program));
        if (solution.status == LinearStatus::infeasible) {
            ++infeasible;
            continue;
        }
        ASSERT_EQ(solution.status, LinearStatus::optimal);
        const VectorXd rows = program.rows * solution.x;
        EXPECT_LT((rows - program.row_upper).maxCoeff(), clp_tolerance);
        EXPECT_NEAR(rows[4], 1, clp_tolerance);
        EXPECT_GE(solution.x.minCoeff(), -clp_tolerance);
    }
    EXPECT_GT(infeasible, 20);
    EXPECT_LT(infeasible, 180);
}

TEST(LinearSolver, NoRowsAndFixedVariables) {
    LinearProgram program;
    program.rows.resize(0, 2);
    program.row_lower.resize(0);
    program.row_upper.resize(0);
    program.lower = Vector2d(-1, 2);
    program.upper = Vector2d(1, 2);
    LinearSolver solver(program);
    const auto solution = solver.minimise(Vector2d(1, 1));
    ASSERT_EQ(solution.status, LinearStatus::optimal);
    EXPECT_EQ(solution.x, VectorXd(Vector2d(-1, 2)));
    // The second solve goes on with the primal method, which CLP itself does not survive here.
    EXPECT_EQ(solver.minimise(Vector2d(-1, 1)).x, VectorXd(Vector2d(1, 2)));
}

TEST(LinearSolver, SizeMismatchThrows) {
    const auto broken = [](auto change) {
        LinearProgram program = wyndor();
        change(program);
        return program;
    };
    EXPECT_THROW(LinearSolver(broken([](auto& p) { p.row_lower.resize(2); })), std::invalid_argument);
    EXPECT_THROW(LinearSolver(broken([](auto& p) { p.row_upper.resize(4); })), std::invalid_argument);
    EXPECT_THROW(LinearSolver(broken([](auto& p) { p.lower.resize(3); })), std::invalid_argument);
    EXPECT_THROW(LinearSolver(broken([](auto& p) { p.upper.resize(1); })), std::invalid_argument);
    LinearSolver solver(wyndor());
    EXPECT_THROW((void)solver.minimise(VectorXd::Zero(3)), std::invalid_argument);
}

TEST(LinearSolver, NamesItsVersion) { EXPECT_TRUE(nsma::clp_version().find('.') != std::string::npos); }

}  // namespace
