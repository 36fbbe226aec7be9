#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "nsma/study/scene.hpp"

namespace nsma {

/// Throws InputError "path: what", on one line.
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what);
/// The same, "cannot be written" with the reason that errno holds.
[[noreturn]] void fail_errno(const std::filesystem::path& path);

/// The bytes of a file; absent where it cannot be opened, with the reason in errno.
[[nodiscard]] std::optional<std::string> contents(const std::filesystem::path& file);

/// The name of a file while it is being written.
[[nodiscard]] std::filesystem::path part_of(const std::filesystem::path& file);
/// Gives a written part its final name.
void put_in_place(const std::filesystem::path& file);
/// Writes a file so that it is there whole or not at all.
void write_whole(const std::filesystem::path& path, const std::string& text);

/// Makes the folder of a study and keeps a copy of its scene there. Throws InputError where it holds the results of
/// another scene or, without a scene, one of `files`; std::invalid_argument on a scene without text.
void prepare_results_folder(const std::filesystem::path& folder, const Scene& scene,
                            std::span<const char* const> files);

}  // namespace nsma
