// What a command reads and must not write over.
#pragma once

#include <filesystem>
#include <set>

namespace relume {

class InputFiles {
  public:
    // Files that are there; others cannot be lost.
    void add(const std::filesystem::path& file);
    void add(const std::set<std::filesystem::path>& files);

    // Throws UsageError that begins with `option` if `output` is one of them, by whatever name.
    void expectNone(const char* option, const std::filesystem::path& output) const;

  private:
    std::set<std::filesystem::path> mFiles; // without links
};

} // namespace relume
