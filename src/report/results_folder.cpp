#include "results_folder.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "one_line.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {

namespace fs = std::filesystem;

void fail(const fs::path& path, const std::string& what) {
    throw InputError(one_line(fmt::format("{}: {}", path.string(), what)));
}

void fail_errno(const fs::path& path) { fail(path, fmt::format("cannot be written: {}", std::strerror(errno))); }

std::optional<std::string> contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return std::nullopt;
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

fs::path part_of(const fs::path& file) { return file.string() + ".part"; }

void put_in_place(const fs::path& file) {
    std::error_code code;
    fs::rename(part_of(file), file, code);
    if (code) fail(file, fmt::format("cannot be written: {}", code.message()));
}

void write_whole(const fs::path& path, const std::string& text) {
    const fs::path part = part_of(path);
    std::FILE* file = std::fopen(part.c_str(), "wb");
    if (file == nullptr) fail_errno(part);
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0 &&
                         (fsync(fileno(file)) == 0 || errno == EINVAL);
    const int code = errno;
    if (std::fclose(file) != 0 || !written) {
        if (!written) errno = code;
        fail_errno(part);
    }
    put_in_place(path);
}

namespace {

// The scene of a folder that has none, unless another process gives it one at the same time.
void write_scene(const fs::path& copy, const std::string& text) {
    const fs::path own = fmt::format("{}.{:x}", copy.string(), std::random_device()());
    write_whole(own, text);
    std::error_code code;
    fs::create_hard_link(own, copy, code);  // unlike a renaming, never over another's
    std::error_code unused;
    if (code && !fs::exists(copy, unused)) {
        fs::rename(own, copy, code);  // a file system without links
        if (code) fail(copy, fmt::format("cannot be written: {}", code.message()));
    }
    fs::remove(own, code);
}

}  // namespace

void prepare_results_folder(const fs::path& folder, const Scene& scene, std::span<const char* const> files) {
    if (scene.text.empty()) throw std::invalid_argument("scene.text: expected the scene file as read, got nothing");
    std::error_code code;
    if (fs::exists(folder, code) && !fs::is_directory(folder, code)) fail(folder, "expected a folder, got a file");
    fs::create_directories(folder, code);
    if (code) fail(folder, fmt::format("cannot be made: {}", code.message()));

    const fs::path copy = folder / "scene.toml";
    if (!fs::exists(copy, code)) {
        for (const char* file : files) {
            if (fs::exists(folder / file, code) && !fs::exists(copy, code)) {
                fail(folder / file, "is in the way: the folder has no scene.toml that would tell its scene");
            }
        }
        write_scene(copy, scene.text);
    }
    const auto text = contents(copy);
    if (!text) fail(copy, fmt::format("cannot be read: {}", std::strerror(errno)));
    if (*text != scene.text) {
        fail(folder,
             "holds results of another scene (its scene.toml differs); choose another folder "
             "or remove it");
    }
}

}  // namespace nsma
