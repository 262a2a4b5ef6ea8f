// A folder of a test's own, removed with all that is in it.
#pragma once

#include "engine/base/file.h"

#include <filesystem>
#include <string>
#include <unistd.h>

namespace relume::test {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "relume-test-XXXXXX").string();
        mPath = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(mPath); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return mPath; }

    // Writes a file into the folder and returns its path.
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        writeFileAtomically(mPath / name, text);
        return mPath / name;
    }

  private:
    std::filesystem::path mPath;
};

} // namespace relume::test
