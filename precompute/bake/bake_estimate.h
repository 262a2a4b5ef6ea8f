// How far a bake is and how long it will take, where vertices of different parts cost differently.
#pragma once

#include "precompute/bake_observer.h"

#include <vector>

namespace relume {

// Vertices weigh what a vertex of their part costs: as measured while the part is baked, before that as its
// probe said, corrected by how wrong the probes of the parts before were.
class BakeEstimate {
  public:
    struct Part {
        uint64_t vertices = 0, doneBefore = 0; // doneBefore: in a checkpoint
        double probedSeconds = 1;              // per vertex, before any is baked; only ratios count
    };

    explicit BakeEstimate(std::vector<Part> parts);

    // `vertices` more of a part are done, after `seconds` of work on them.
    void add(size_t part, uint64_t vertices, double seconds);

    BakeStatus status() const;

  private:
    struct Work {
        Part part;
        uint64_t done = 0; // by this run
        double seconds = 0;
    };
    double cost(const Work& work, double correction) const;

    std::vector<Work> mWork;
};

} // namespace relume
