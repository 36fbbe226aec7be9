#pragma once

#include <cstddef>

namespace nsma {

/// The place of a step or pattern in a container.
inline std::size_t index(long n) { return static_cast<std::size_t>(n); }

}  // namespace nsma
