// The compute programs of a device, which are made once each.
#pragma once

#include "engine/vk/program.h"

#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace relume::vk {

// Keeps every compute program that was made on a device until the device goes, since a driver takes 10 to 150
// ms for one and each part of a scene needs the same. Any thread may use it.
class ComputePrograms {
  public:
    // What a program is made from.
    struct Source {
        std::vector<uint32_t> spirv;
        Constants constants;
        ComputeProgram::Subgroups subgroups;

        auto operator<=>(const Source&) const = default;
    };

    // Returns the program of `source` if there is one.
    std::optional<ComputeProgram> find(const Source& source) const;

    // Keeps `program`, and returns it, or the one of `source` that another thread added first.
    ComputeProgram add(Source source, ComputeProgram program);

  private:
    mutable std::mutex mMutex;
    std::map<Source, ComputeProgram> mPrograms;
};

} // namespace relume::vk
