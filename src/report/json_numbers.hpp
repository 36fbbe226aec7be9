#pragma once

#include <limits>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace nsma {

/// A whole number that fits. Throws std::invalid_argument on anything else: the library would cut it to size.
template <class Value = int>
[[nodiscard]] Value whole_number(const nlohmann::json& json) {
    const bool fits = json.is_number_unsigned()
                          ? json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<Value>::max())
                          : json.is_number_integer() && json.get<std::int64_t>() >= std::numeric_limits<Value>::min();
    if (!fits) throw std::invalid_argument("a number that is not whole or too large: " + json.dump().substr(0, 40));
    return json.get<Value>();
}

}  // namespace nsma
