#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "nsma/study/scene.hpp"

namespace nsma {

/// Throws InputError "path: what", on one line.
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what);
/// The same, "cannot be written" with the reason that errno holds.
[[noreturn]] void fail_errno(const std::filesystem::path& path);

/// A file that is called NAME.part until it is whole. Throws InputError (one line) where it cannot be written.
class PartFile {
public:
    enum class Old {
        removed,  ///< whatever NAME.part holds
        kept      ///< it is written on, by this process alone: where another has it so, InputError
    };
    explicit PartFile(std::filesystem::path file, Old old = Old::removed);

    /// Keeps only the first bytes of what is there.
    void cut(std::uintmax_t size);
    /// Appends text, at once for other processes to read.
    void write(std::string_view text);
    /// To the disk; nothing can be written any more.
    void close();
    /// To the disk where it is open; gives the file its name, then closes it.
    void put_in_place();

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void store();

    std::filesystem::path file_, part_;
    std::unique_ptr<std::FILE, Close> stream_;
};

/// Writes a file so that it is there whole or not at all.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// Makes a folder where there is none. Throws InputError where that cannot be done or a file has the name.
void make_folder(const std::filesystem::path& folder);

/// Throws InputError unless there is such a folder and it can be read; `what` it should be: "the folder of a sweep".
void expect_folder(const std::filesystem::path& folder, const std::string& what);

/// Bytes of the longest scene file.
inline constexpr std::size_t max_scene_bytes = 16u << 20;

/// Makes the folder of a study and keeps a copy of its scene there. Throws InputError where it holds the results of
/// another scene or, without a scene, one of `files`; std::invalid_argument on a scene without text.
void prepare_results_folder(const std::filesystem::path& folder, const Scene& scene,
                            std::span<const char* const> files);

}  // namespace nsma
