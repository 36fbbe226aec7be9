#pragma once

#include <vector>

#include "accuracy_folder.hpp"

namespace nsma {

/// Heat maps of where each method fails, and of the tolerance of the dense kernel methods.
[[nodiscard]] std::vector<Chart> stability_charts(const AccuracyResults& results);

}  // namespace nsma
