#include "nsma/wave/state.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace nsma {

namespace {

void require_size(const Mesh& mesh, const State& state) {
    validate(mesh);
    if (state.size() != mesh.window()) {
        throw std::invalid_argument(fmt::format("state: expected size {}, got {}", mesh.window(), state.size()));
    }
}

}  // namespace

double energy(const Bar& bar, const Mesh& mesh, const State& state) {
    require_size(mesh, state);
    const double stress_part = state.head(mesh.cells).squaredNorm() / (2.0 * bar.young_modulus);
    const double velocity_part = state.tail(mesh.cells).squaredNorm() * (0.5 * bar.density);
    return bar.area * mesh.cell_length(bar) * (stress_part + velocity_part);
}

double tip_displacement(const Bar& bar, const Mesh& mesh, const State& state) {
    require_size(mesh, state);
    return mesh.cell_length(bar) / bar.young_modulus * state.head(mesh.cells).sum();
}

void validate(const Mesh& mesh, const State& state) {
    require_size(mesh, state);
    for (Eigen::Index i = 0; i < state.size(); ++i) {
        if (!std::isfinite(state[i])) {
            throw std::invalid_argument(fmt::format("state: expected finite values, got {} at entry {}", state[i], i));
        }
    }
}

}  // namespace nsma
