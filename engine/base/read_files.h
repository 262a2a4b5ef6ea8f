// A record of the files that a process reads, kept so that it does not overwrite them.
#pragma once

#include <filesystem>
#include <set>

namespace relume {

// Collects the names of files that readFile() and FileReader open during its lifetime, on any thread. Only
// one may exist at a time.
class ReadFiles {
  public:
    ReadFiles();
    ~ReadFiles();
    ReadFiles(const ReadFiles&) = delete;
    ReadFiles& operator=(const ReadFiles&) = delete;

    std::set<std::filesystem::path> paths() const;

    static void add(const std::filesystem::path& path); // does nothing if there is no collector

  private:
    std::set<std::filesystem::path> mPaths;
};

} // namespace relume
