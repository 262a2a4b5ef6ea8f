// The compute programs of a device, which are made once each.
#pragma once

#include "engine/vk/program.h"

#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace relume::vk {

// Keeps the compute programs that were made on a device, since a driver takes 10 to 150 ms for one and each
// part of a scene needs the same. They stay until the device goes or shaders are replaced; a device that
// bakes many scenes has one more for each depth of an occluder's hierarchy and each number of terms. Any
// thread may use it.
class ComputePrograms {
  public:
    // A source is all that decides what a program does.
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

    // Forgets all programs. Those in use stay usable.
    void clear();

  private:
    mutable std::mutex mMutex;
    std::map<Source, ComputeProgram> mPrograms;
};

} // namespace relume::vk
