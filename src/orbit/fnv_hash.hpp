#pragma once

#include <cstdint>

namespace nsma {

/// FNV-1a of 64 bits.
class FnvHash {
public:
    void add(std::uint64_t part) { value_ = (value_ ^ part) * 1099511628211U; }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 14695981039346656037U;
};

}  // namespace nsma
