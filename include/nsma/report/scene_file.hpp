#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "nsma/study/scene.hpp"

namespace nsma {

/// A scene, flag or folder the user can mend: the message is one line with what, where,
/// expected and got.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reads and checks a scene file (TOML, SI units). Every key is required unless the README says
/// otherwise; unknown, missing, mistyped or out-of-range keys throw InputError naming file,
/// line and key.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);

/// The same from text; `where` stands for the file in messages.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& where);

}  // namespace nsma
