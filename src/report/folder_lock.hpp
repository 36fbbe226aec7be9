#pragma once

#include <filesystem>

namespace nsma {

/// A results folder, made if missing, for one process of nsma alone: from the first look at what it holds to the last
/// chart. Throws InputError (one line) where another has it, naming that process, or where it cannot be had. The lock
/// ends with its process, however that ends; its empty file stays.
class FolderLock {
public:
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace nsma
