#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace nsma {

/// Where a text of JSON or TOML is nested deeper than `limit`: brackets in brackets, or parts of one dotted key. The
/// libraries that read them recurse once a level. Of malformed text it says no more than that it is too deep.
[[nodiscard]] std::optional<std::size_t> too_deep(std::string_view text, int limit);

}  // namespace nsma
