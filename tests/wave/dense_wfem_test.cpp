#include "wave/dense_wfem.hpp"

#include <random>
#include <stdexcept>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace {

using Eigen::MatrixXd;
using nsma::Bar;
using nsma::Mesh;
using nsma::State;

/// The matrix over [sigma/z; v], where the energy is a multiple of the Euclidean norm.
MatrixXd scaled(const Bar& bar, MatrixXd matrix) {
    const Eigen::Index cells = matrix.rows() / 2;
    matrix.topRightCorner(cells, cells) /= bar.impedance();
    matrix.bottomLeftCorner(cells, cells) *= bar.impedance();
    return matrix;
}

MatrixXd repeated(const MatrixXd& matrix, int times) {
    MatrixXd result = MatrixXd::Identity(matrix.rows(), matrix.cols());
    for (int i = 0; i < times; ++i) {
        result = matrix * result;
    }
    return result;
}

const Bar bars[] = {{}, {1.0, 210e9, 7850.0, 1e-4, 1e-4}};

TEST(DenseWfem, OneCellByHand) {
    // z = 1: the fixed end gives sigma* = sigma + v, v* = 0. Free: sigma* = 0, v* = v - sigma,
    // so (sigma, v) -> (v, -sigma). Contact: sigma* = sigma - v, v* = 0: (sigma, v) -> (sigma, -v).
    const MatrixXd free = nsma::dense::free_step_matrix(Bar{}, Mesh{1});
    const MatrixXd contact = nsma::dense::contact_step_matrix(Bar{}, Mesh{1});
    EXPECT_EQ(free, (MatrixXd(2, 2) << 0, 1, -1, 0).finished());
    EXPECT_EQ(contact, (MatrixXd(2, 2) << 1, 0, 0, -1).finished());
}

TEST(DenseWfem, StepsAreOrthogonalInTheEnergyNorm) {
    for (const Bar& bar : bars) {
        for (int cells = 1; cells <= 12; ++cells) {
            const MatrixXd identity = MatrixXd::Identity(2 * cells, 2 * cells);
            for (const MatrixXd& step : {nsma::dense::free_step_matrix(bar, Mesh{cells}),
                                         nsma::dense::contact_step_matrix(bar, Mesh{cells})}) {
                const MatrixXd matrix = scaled(bar, step);
                // Entries are 0, +-1/2, +-1 after two roundings by z.
                EXPECT_LT((matrix.transpose() * matrix - identity).cwiseAbs().maxCoeff(), 1e-14);
            }
        }
    }
}

TEST(DenseWfem, RoundTripsOfTheBar) {
    for (const Bar& bar : bars) {
        for (int cells = 1; cells <= 8; ++cells) {
            const MatrixXd identity = MatrixXd::Identity(2 * cells, 2 * cells);
            const MatrixXd free = scaled(bar, nsma::dense::free_step_matrix(bar, Mesh{cells}));
            const MatrixXd contact = scaled(bar, nsma::dense::contact_step_matrix(bar, Mesh{cells}));
            const double rounding = 1e-13;  // up to 32 products of orthogonal matrices
            EXPECT_LT((repeated(free, 2 * cells) + identity).norm(), rounding);
            EXPECT_LT((repeated(free, 4 * cells) - identity).norm(), rounding);
            EXPECT_LT((repeated(contact, 2 * cells) - identity).norm(), rounding);
        }
    }
}

TEST(DenseWfem, CellStepEqualsTheMatrices) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (const Bar& bar : bars) {
        for (const int cells : {1, 2, 3, 7, 16}) {
            for (const bool contact : {false, true}) {
                State state = State::NullaryExpr(2 * cells, [&](Eigen::Index) { return normal(random); });
                state.head(cells) *= bar.impedance();
                const MatrixXd matrix = contact ? nsma::dense::contact_step_matrix(bar, Mesh{cells})
                                                : nsma::dense::free_step_matrix(bar, Mesh{cells});
                State difference = matrix * state;
                nsma::dense::cell_step(bar, Mesh{cells}, contact, state);
                difference -= state;
                difference.head(cells) /= bar.impedance();
                // Numbers of order 1, half a dozen operations each.
                EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-14);
            }
        }
    }
}

TEST(DenseWfem, PeriodicityMatrixIsTheRepeatedProduct) {
    const Bar bar;
    const Mesh mesh{3};
    const MatrixXd free = nsma::dense::free_step_matrix(bar, mesh);
    const MatrixXd contact = nsma::dense::contact_step_matrix(bar, mesh);
    for (int r = 1; r <= 9; ++r) {
        for (int p = 1; p <= 9; ++p) {
            const MatrixXd expected = repeated(contact, p) * repeated(free, r) - MatrixXd::Identity(6, 6);
            // z = 1: every entry is a multiple of 1/2 and exact.
            EXPECT_EQ(nsma::dense::periodicity_matrix(bar, mesh, r, p), expected);
        }
    }
}

TEST(DenseWfem, Misuse) {
    const Bar bar;
    EXPECT_THROW((void)nsma::dense::periodicity_matrix(bar, Mesh{3}, 0, 1), std::invalid_argument);
    EXPECT_THROW((void)nsma::dense::periodicity_matrix(bar, Mesh{3}, 1, 0), std::invalid_argument);
    EXPECT_THROW((void)nsma::dense::free_step_matrix(bar, Mesh{0}), std::invalid_argument);
    State state = State::Zero(5);
    EXPECT_THROW(nsma::dense::cell_step(bar, Mesh{3}, false, state), std::invalid_argument);
}

}  // namespace
