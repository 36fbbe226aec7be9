#pragma once

#include "nsma/wave/bar.hpp"

namespace nsma {

/// Uniform mesh of N cells whose time step is the travel time of one cell, so that waves move
/// exactly one cell a step. Source: [1] Eq. (1).
struct Mesh {
    int cells = 1;  ///< N, >= 1

    [[nodiscard]] int window() const { return 2 * cells; }   ///< 2N: steps of one round trip
    [[nodiscard]] double cell_length(const Bar& bar) const;  ///< dx = L/N [m]
    [[nodiscard]] double time_step(const Bar& bar) const;    ///< dt = dx/c [s]
};

/// Largest N accepted by validate(): products such as 4 N^2 must stay exact in 64 bits.
inline constexpr int max_cells = 1'000'000;

/// Throws std::invalid_argument unless 1 <= N <= max_cells.
void validate(const Mesh& mesh);

}  // namespace nsma
