#include "folder_lock.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "results_folder.hpp"

namespace nsma {

FolderLock::FolderLock(const std::filesystem::path& folder) {
    make_folder(folder);
    const std::filesystem::path path = folder / ".nsma-lock";
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) fail_errno(path);
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    if (fcntl(file_, F_SETLK, &lock) == 0) return;
    const int error = errno;
    const bool taken = error == EAGAIN || error == EACCES;
    const bool known = taken && fcntl(file_, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK && lock.l_pid > 0;
    close(file_);
    if (known) fail(folder, fmt::format("is in use by process {}", lock.l_pid));
    if (taken) fail(folder, "is in use by another process");  // of another machine
    fail(path, fmt::format("cannot be locked: {}", std::strerror(error)));
}

FolderLock::~FolderLock() { close(file_); }

}  // namespace nsma
