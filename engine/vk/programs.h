// The programs of a device, which are made once each.
#pragma once

#include "engine/vk/program.h"

#include <map>
#include <mutex>
#include <vector>

namespace relume::vk {

// Keeps the programs that were made on a device, since a driver takes 10 to 300 ms for one, and parts of a
// scene and views of assets need the same. They stay until the device goes or shaders are replaced, with some
// 100 KB of SPIR-V each: one more for each depth of an occluder's hierarchy, each number of terms, and each
// way of shading that was drawn. Any thread may use it.
class Programs {
  public:
    // A source is all that decides what a program does.
    struct Source {
        std::vector<std::vector<uint32_t>>
            shaders; // SPIR-V of the compute shader, or the vertex and fragment one
        Constants constants;
        Subgroups subgroups = Subgroups::Any; // of compute programs
        GraphicsOptions options;              // of graphics programs

        auto operator<=>(const Source&) const = default;
    };

    // Returns the program of `source`; an empty one if there is none.
    Program find(const Source& source) const;

    // Keeps `program`, and returns it, or the one of `source` that another thread added first.
    Program add(Source source, Program program);

    // Forgets all programs. Those in use stay usable.
    void clear();

  private:
    mutable std::mutex mMutex;
    std::map<Source, Program> mPrograms;
};

} // namespace relume::vk
