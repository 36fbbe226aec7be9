#pragma once

#include <string>
#include <string_view>

#include "nsma/check/certificate.hpp"

namespace nsma {

/// A certificate as one line of JSON: integers for indices, fractions as text ("12/11").
/// Fields: data/README.md.
[[nodiscard]] std::string certificate_json(const Certificate& certificate);

/// Reads one back. Every field is checked: an unknown, missing or mistyped one throws InputError
/// with one line that starts with `where`. Whether the proof holds is check()'s to say.
[[nodiscard]] Certificate parse_certificate(std::string_view text, const std::string& where);

}  // namespace nsma
