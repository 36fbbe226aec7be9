#pragma once

#include <filesystem>

#include "nsma/wave/state.hpp"

namespace nsma {

/// A state from a CSV file: the line `stress_pa,velocity_m_s`, then a line for each cell from the held end on. Throws
/// InputError (file, line, expected, got).
[[nodiscard]] State read_state(const std::filesystem::path& file, const Mesh& mesh);

}  // namespace nsma
