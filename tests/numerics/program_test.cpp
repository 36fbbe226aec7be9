#include "numerics/program.hpp"

#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using nsma::no_bound;
using nsma::Program;

/// x'Hx/2 + g.x + 7 with H = [[2, 1, 0], [1, 0, 0], [0, 0, -4]], x0 - x2 = 1, x0 + x1 <= 2,
/// 0 <= x0, x1 <= 5, x0^2 + x1^2 = 1.
Program example() {
    Program program;
    Eigen::Matrix3d hessian;
    hessian << 2, 1, 0, 1, 0, 0, 0, 0, -4;
    program.hessian = hessian.sparseView();
    program.gradient = Vector3d(1, -1, 2);
    program.constant = 7;
    program.equalities = Eigen::MatrixXd(Vector3d(1, 0, -1).transpose()).sparseView();
    program.equality_values = VectorXd::Constant(1, 1);
    program.inequalities = Eigen::MatrixXd(Vector3d(1, 1, 0).transpose()).sparseView();
    program.inequality_values = VectorXd::Constant(1, 2);
    program.lower = Vector3d(0, -no_bound, -no_bound);
    program.upper = Vector3d(no_bound, 5, no_bound);
    program.sphere_variables = 2;
    return program;
}

TEST(Program, ObjectiveByHand) {
    // x = (1, 2, 3): (2 + 2*2 - 36)/2 + 1 - 2 + 6 + 7 = -15 + 12 = -3.
    EXPECT_EQ(example().objective(Vector3d(1, 2, 3)), -3.0);
}

TEST(Program, GradientByFiniteDifferences) {
    const Program program = example();
    std::mt19937 random(8);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 20; ++trial) {
        const VectorXd x = VectorXd::NullaryExpr(3, [&](Eigen::Index) { return normal(random); });
        const VectorXd gradient = program.objective_gradient(x);
        for (Eigen::Index j = 0; j < 3; ++j) {
            const double h = 1e-3;  // central differences of a quadratic have no truncation error
            const VectorXd e = VectorXd::Unit(3, j) * h;
            EXPECT_NEAR(gradient[j], (program.objective(x + e) - program.objective(x - e)) / (2 * h), 1e-10);
        }
    }
}

TEST(Program, ViolationIsTheWorstOfEachKind) {
    const Program program = example();
    EXPECT_EQ(program.violation(Vector3d(1, 0, 0)), 0.0);
    EXPECT_DOUBLE_EQ(program.violation(Vector3d(1, 0, 0.25)), 0.25);  // equality
    EXPECT_DOUBLE_EQ(program.violation(Vector3d(-1, 0, -2)), 1.0);    // lower bound
    EXPECT_DOUBLE_EQ(program.violation(Vector3d(0, 1, -1)), 0.0);
    EXPECT_DOUBLE_EQ(program.violation(Vector3d(0, 2, -1)), 3.0);           // sphere: 4 - 1
    EXPECT_DOUBLE_EQ(program.sphere_residual(Vector3d(0.5, 0, 9)), -0.75);  // x2 is off the sphere
    Program flat = example();
    flat.sphere_variables = 0;
    EXPECT_EQ(flat.sphere_residual(Vector3d(5, 5, 5)), 0.0);
    EXPECT_DOUBLE_EQ(flat.violation(Vector3d(2, 3, 1)), 3.0);   // inequality: 5 - 2
    EXPECT_DOUBLE_EQ(flat.violation(Vector3d(0, 9, -1)), 7.0);  // inequality over the bound
    flat.inequality_values[0] = 100;
    EXPECT_DOUBLE_EQ(flat.violation(Vector3d(0, 9, -1)), 4.0);  // upper bound
    EXPECT_DOUBLE_EQ(flat.violation(Vector3d(3, 0, 2)), 0.0);   // slack is no violation
}

TEST(Program, ViolationOfNonsenseIsInfinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(example().violation(Vector3d(1, nan, 0)), no_bound);
    EXPECT_EQ(example().violation(Vector3d(no_bound, 0, 0)), no_bound);
    EXPECT_EQ(example().violation(VectorXd::Zero(2)), no_bound);
}

TEST(Program, ValidateNamesWhatIsWrong) {
    EXPECT_NO_THROW(validate(example()));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    struct Case {
        const char* named;
        std::function<void(Program&)> breakage;
    };
    const std::vector<Case> cases{
        {"variables", [](Program& p) { p.lower.resize(0); }},
        {"upper", [](Program& p) { p.upper.resize(2); }},
        {"gradient", [](Program& p) { p.gradient.resize(4); }},
        {"gradient", [&](Program& p) { p.gradient[1] = nan; }},
        {"hessian", [](Program& p) { p.hessian.resize(3, 2); }},
        {"hessian", [](Program& p) { p.hessian.resize(2, 3); }},
        {"hessian", [&](Program& p) { p.hessian.coeffRef(0, 0) = nan; }},
        {"equalities", [](Program& p) { p.equalities.resize(1, 2); }},
        {"equality_values", [](Program& p) { p.equality_values.resize(0); }},
        {"equality_values", [&](Program& p) { p.equality_values[0] = no_bound; }},
        {"equalities", [&](Program& p) { p.equalities.coeffRef(0, 0) = no_bound; }},
        {"inequalities", [](Program& p) { p.inequalities.resize(1, 4); }},
        {"inequality_values", [](Program& p) { p.inequality_values.resize(2); }},
        {"inequality_values", [&](Program& p) { p.inequality_values[0] = nan; }},
        {"inequalities", [&](Program& p) { p.inequalities.coeffRef(0, 1) = nan; }},
        {"sphere_variables", [](Program& p) { p.sphere_variables = 4; }},
        {"sphere_variables", [](Program& p) { p.sphere_variables = -1; }},
        {"lower[1]", [](Program& p) { p.lower[1] = 6; }},
        {"lower[0]", [&](Program& p) { p.lower[0] = nan; }},
        {"lower[2]", [&](Program& p) { p.upper[2] = nan; }},
    };
    for (const auto& item : cases) {
        Program program = example();
        item.breakage(program);
        try {
            validate(program);
            ADD_FAILURE() << "accepted: " << item.named;
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find(item.named), std::string::npos) << error.what();
        }
    }
}

}  // namespace
