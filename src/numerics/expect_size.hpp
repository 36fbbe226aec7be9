#pragma once

#include <stdexcept>
#include <string>

namespace nsma {

/// Throws std::invalid_argument (name, expected, got) unless a size is the expected one.
inline void expect_size(const char* name, long expected, long got) {
    if (expected == got) return;
    throw std::invalid_argument(std::string(name) + ": expected size " + std::to_string(expected) + ", got " +
                                std::to_string(got));
}

}  // namespace nsma
