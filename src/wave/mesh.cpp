#include "nsma/wave/mesh.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace nsma {

double Mesh::cell_length(const Bar& bar) const { return bar.length / cells; }

double Mesh::time_step(const Bar& bar) const { return bar.travel_time() / cells; }

void validate(const Mesh& mesh) {
    if (mesh.cells < 1 || mesh.cells > max_cells) {
        throw std::invalid_argument(fmt::format("cells: expected 1 to {}, got {}", max_cells, mesh.cells));
    }
}

}  // namespace nsma
