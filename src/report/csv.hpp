#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace nsma {

/// One CSV field, quoted if it has to be (RFC 4180); control characters become blanks.
[[nodiscard]] std::string csv_text(std::string_view text);
/// The shortest decimal that reads back to the same double; empty unless finite.
[[nodiscard]] std::string csv_number(double value);
[[nodiscard]] std::string csv_number(const std::optional<double>& value);
}  // namespace nsma
