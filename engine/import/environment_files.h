// Environments that light is made of, from files: each read once, if it is asked for often.
#pragma once

#include "engine/light/light.h"

#include <filesystem>
#include <list>
#include <map>
#include <set>
#include <vector>

namespace relume {

class EnvironmentFiles {
  public:
    // Prepared for sampling; of an empty path the built-in sky. Throws Error.
    std::shared_ptr<const Environment> map(const std::filesystem::path& file);

    // As it is looked at, of a few files at a time; null unless keepPictures() was called. Throws Error.
    std::shared_ptr<const Environment> picture(const std::filesystem::path& file);
    void keepPictures() { mKeepsPictures = true; }

    // The files whose names have a number where `pattern` has ####, by rising number, whatever its digits; as
    // they were when first asked for. Throws Error when there are none, or two of the same number.
    const std::vector<std::filesystem::path>& sequence(const std::filesystem::path& pattern);

    // All that were asked for, those of sequences whether or not they were read.
    const std::set<std::filesystem::path>& named() const { return mNamed; }

  private:
    using Kept = std::list<std::pair<std::filesystem::path, std::shared_ptr<const Environment>>>;

    static std::shared_ptr<const Environment> find(Kept& kept, const std::filesystem::path& file);
    static void keep(Kept& kept, size_t most, const std::filesystem::path& file,
                     std::shared_ptr<const Environment> environment);

    Kept mMaps, mPictures; // the latest first
    bool mKeepsPictures = false;
    std::map<std::filesystem::path, std::vector<std::filesystem::path>> mSequences;
    std::set<std::filesystem::path> mNamed;
};

// Whether a path stands for a sequence: its file's name has a #, and there is no such file.
bool isSequence(const std::filesystem::path& path);

} // namespace relume
