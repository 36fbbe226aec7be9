#include "results_folder.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_file.hpp"
#include "one_line.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {

namespace fs = std::filesystem;

void fail(const fs::path& path, const std::string& what) {
    throw InputError(one_line(fmt::format("{}: {}", path.string(), what)));
}

void fail_errno(const fs::path& path) { fail(path, fmt::format("cannot be written: {}", std::strerror(errno))); }

PartFile::PartFile(fs::path file, Old old)
    : file_(std::move(file)),
      part_(file_.string() + ".part"),
      stream_(std::fopen(part_.c_str(), old == Old::kept ? "abe" : "wb")) {
    if (!stream_) fail_errno(part_);
    if (old == Old::removed) return;
    const bool locked = flock(fileno(stream_.get()), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    // Until it was locked another process may have finished it and given it its name.
    struct stat ours {};
    struct stat there {};
    const bool same = fstat(fileno(stream_.get()), &ours) == 0 && stat(part_.c_str(), &there) == 0 &&
                      ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
    if (!locked || !same) fail(part_, "is in use by another process");
}

void PartFile::cut(std::uintmax_t size) {
    if (ftruncate(fileno(stream_.get()), static_cast<off_t>(size)) != 0) fail_errno(part_);
}

void PartFile::write(std::string_view text) {
    std::FILE* stream = stream_.get();
    if (std::fwrite(text.data(), 1, text.size(), stream) != text.size() || std::fflush(stream) != 0) fail_errno(part_);
}

void PartFile::store() {
    if (fsync(fileno(stream_.get())) != 0 && errno != EINVAL) fail_errno(part_);  // a pipe or a device has no disk
}

void PartFile::close() {
    store();
    if (std::fclose(stream_.release()) != 0) fail_errno(part_);
}

void PartFile::put_in_place() {
    if (stream_) store();
    std::error_code code;
    fs::rename(part_, file_, code);
    if (code) fail(file_, fmt::format("cannot be written: {}", code.message()));
    stream_.reset();  // only now: a lock ends with it
}

void write_whole(const fs::path& file, std::string_view text) {
    PartFile part(file);
    part.write(text);
    part.put_in_place();
}

void make_folder(const fs::path& folder) {
    std::error_code code;
    if (fs::exists(folder, code) && !fs::is_directory(folder, code)) fail(folder, "expected a folder, got a file");
    fs::create_directories(folder, code);
    if (code) fail(folder, fmt::format("cannot be made: {}", code.message()));
}

void expect_folder(const fs::path& folder, const std::string& what) {
    std::error_code code;
    const fs::file_status status = fs::status(folder, code);
    if (status.type() == fs::file_type::none) fail(folder, fmt::format("cannot be read: {}", code.message()));
    if (!fs::is_directory(status))
        fail(folder, fmt::format("expected {}, got {}", what, fs::exists(status) ? "a file" : "nothing"));
}

void prepare_results_folder(const fs::path& folder, const Scene& scene, std::span<const char* const> files) {
    if (scene.text.empty()) throw std::invalid_argument("scene.text: expected the scene file as read, got nothing");
    make_folder(folder);
    const fs::path copy = folder / "scene.toml";
    std::error_code code;
    if (!fs::exists(copy, code)) {
        if (code) fail(copy, fmt::format("cannot be read: {}", code.message()));
        for (const char* file : files) {
            if (fs::exists(folder / file, code)) {
                fail(folder / file, "is in the way: the folder has no scene.toml that would tell its scene");
            }
        }
        write_whole(copy, scene.text);
    } else if (InputFile(copy, "the scene of the folder").text(max_scene_bytes) != scene.text) {
        fail(folder,
             "holds results of another scene (its scene.toml differs); choose another folder "
             "or remove it");
    }
}

}  // namespace nsma
