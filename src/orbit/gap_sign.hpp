#pragma once

#include <stdexcept>

#include <fmt/format.h>

namespace nsma {

/// Throws std::invalid_argument unless it is -1, 0 or 1.
inline void validate_gap_sign(int gap_sign) {
    if (gap_sign < -1 || gap_sign > 1) {
        throw std::invalid_argument(fmt::format("gap_sign: expected -1, 0 or 1, got {}", gap_sign));
    }
}

}  // namespace nsma
