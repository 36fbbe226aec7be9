#pragma once

#include <cstdint>
#include <string>

#include "study/sweep/record_fields.hpp"

namespace nsma {

/// 64-bit FNV-1a of a text, 16 hexadecimal digits.
[[nodiscard]] std::string hash_of(const std::string& text);

/// Of a result with everything that belongs to it, its orbit as stored, so that no row of it can be lost or changed
/// unseen.
[[nodiscard]] std::int64_t checksum(const ResultRows& rows, const std::string& beta);

}  // namespace nsma
