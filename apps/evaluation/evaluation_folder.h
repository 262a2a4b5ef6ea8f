// Folders that an evaluation writes to.
#pragma once

#include <filesystem>

namespace relume {

// Makes it and those above it unless they are there. Throws Error.
void makeFolder(const std::filesystem::path& folder);

// Keeps other evaluations out of a folder, as far as its file system knows locks. Leaves nothing behind.
class FolderLock {
  public:
    // Makes the folder. Throws Error when another process has the lock.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int mFolder = -1;
};

} // namespace relume
