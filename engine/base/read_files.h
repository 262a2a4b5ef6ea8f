// A record of the files that a process reads, so that it does not overwrite them.
#pragma once

#include <filesystem>
#include <set>

namespace relume {

// Collects the names of files that readFile() and FileReader open while it lives, on any thread. At most one
// lives at a time.
class ReadFiles {
  public:
    ReadFiles();
    ~ReadFiles();
    ReadFiles(const ReadFiles&) = delete;
    ReadFiles& operator=(const ReadFiles&) = delete;

    std::set<std::filesystem::path> paths() const;

    static void add(const std::filesystem::path& path); // does nothing while none lives

  private:
    std::set<std::filesystem::path> mPaths;
};

} // namespace relume
