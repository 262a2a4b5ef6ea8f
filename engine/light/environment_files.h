// Environments that light is made of, from files: each read once, if it is asked for often.
#pragma once

#include "engine/light/light.h"

#include <filesystem>
#include <list>
#include <map>
#include <string>
#include <vector>

namespace relume {

class EnvironmentFiles {
  public:
    // Prepared for sampling. Throws Error.
    std::shared_ptr<const Environment> map(const std::filesystem::path& file);

    // The files whose names have a number where `pattern` has ####, by rising number, whatever its digits; as
    // they were when first asked for. Throws Error when there are none, or two of the same number.
    const std::vector<std::filesystem::path>& sequence(const std::filesystem::path& pattern);

  private:
    std::list<std::pair<std::filesystem::path, std::shared_ptr<const Environment>>> mMaps; // the latest first
    std::map<std::filesystem::path, std::vector<std::filesystem::path>> mSequences;
};

// Whether a name stands for a sequence: it has a #.
bool isSequence(const std::string& name);

} // namespace relume
