// Environments of a light, read from files and cached.
#pragma once

#include "engine/light/light.h"

#include <filesystem>
#include <list>
#include <map>
#include <set>
#include <vector>

namespace relume {

// Reads environments, keeping the 64 maps and 4 pictures used last.
class EnvironmentFiles {
  public:
    // Returns the map, prepared for sampling; for an empty path the built-in sky. Throws Error.
    std::shared_ptr<const Environment> map(const std::filesystem::path& file);

    // Returns the map for display (makePicture()), or null unless keepPictures() was called. Throws Error.
    std::shared_ptr<const Environment> picture(const std::filesystem::path& file);
    void keepPictures() { mKeepsPictures = true; }

    // Returns the files whose names have a number where `pattern` has ####, by rising number, of any number
    // of digits. They are listed at the first call. Throws Error if there are none, or two of one number.
    const std::vector<std::filesystem::path>& sequence(const std::filesystem::path& pattern);

    // Returns all files that were asked for, including those of sequences whether or not they were read.
    const std::set<std::filesystem::path>& named() const { return mNamed; }

  private:
    using Kept = std::list<std::pair<std::filesystem::path, std::shared_ptr<const Environment>>>;

    static std::shared_ptr<const Environment> find(Kept& kept, const std::filesystem::path& file);
    static void keep(Kept& kept, size_t most, const std::filesystem::path& file,
                     std::shared_ptr<const Environment> environment);

    Kept mMaps, mPictures; // most recently used first
    bool mKeepsPictures = false;
    std::map<std::filesystem::path, std::vector<std::filesystem::path>> mSequences;
    std::set<std::filesystem::path> mNamed;
};

// Returns whether a path stands for a sequence: its file name has a #, and no such file exists.
bool isSequence(const std::filesystem::path& path);

} // namespace relume
