#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sweep_work.hpp"

namespace nsma {

/// Bytes for another process of the same machine type, and back. Throws std::invalid_argument
/// on bytes that do not fit.
[[nodiscard]] std::string packed(const std::vector<WorkUnit>& units);
[[nodiscard]] std::vector<WorkUnit> unpacked_units(std::string_view bytes);
[[nodiscard]] std::string packed(const std::vector<WorkResult>& results);
[[nodiscard]] std::vector<WorkResult> unpacked_results(std::string_view bytes, const Bar& bar);

}  // namespace nsma
