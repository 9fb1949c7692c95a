// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace apsl::scenes {

/// A folder that one program at a time writes into. Nothing is left there, and the lock ends with the program, however
/// that ends.
class FolderLock {
public:
    /// Throws InputError naming the folder where another holds it. A file system without locks is taken as it is.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_;
};

}  // namespace apsl::scenes
