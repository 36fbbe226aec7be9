#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "nsma/study/scene.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {

/// Least level accepted: beyond it and greatest_level what is computed would leave the range of numbers.
inline constexpr double least_level = 1e-30;
/// Greatest level accepted.
inline constexpr double greatest_level = 1e30;

/// Reads and checks a scene file (TOML, SI units). Every key is required unless the README says
/// otherwise; unknown, missing, mistyped or out-of-range keys throw InputError naming file,
/// line and key.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);

/// The scene with another number of cells or another gap, in its text as well.
[[nodiscard]] Scene with_changes(const Scene& scene, std::optional<int> cells, std::optional<double> gap,
                                 const std::string& where);

/// The same from text; `where` stands for the file in messages.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& where);

}  // namespace nsma
