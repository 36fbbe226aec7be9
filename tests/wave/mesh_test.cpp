#include "nsma/wave/mesh.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace {

using nsma::Bar;
using nsma::Mesh;

TEST(Mesh, WaveCrossesOneCellAStep) {
    const Bar bar{2.0, 210e9, 7850.0, 1e-4, 1e-4};
    const Mesh mesh{20};
    EXPECT_EQ(mesh.window(), 40);
    EXPECT_EQ(mesh.cell_length(bar), 0.1);
    // Two roundings.
    EXPECT_NEAR(bar.wave_speed() * mesh.time_step(bar) / mesh.cell_length(bar), 1.0, 1e-15);
}

TEST(Mesh, ValidateBoundsTheNumberOfCells) {
    EXPECT_NO_THROW(nsma::validate(Mesh{1}));
    EXPECT_NO_THROW(nsma::validate(Mesh{nsma::max_cells}));
    EXPECT_THROW(nsma::validate(Mesh{0}), std::invalid_argument);
    EXPECT_THROW(nsma::validate(Mesh{-3}), std::invalid_argument);
    EXPECT_THROW(nsma::validate(Mesh{nsma::max_cells + 1}), std::invalid_argument);
}

}  // namespace
