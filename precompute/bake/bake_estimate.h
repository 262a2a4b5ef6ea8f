// Estimates the progress and the remaining time of a bake whose parts differ in cost per vertex.
#pragma once

#include "precompute/bake_observer.h"

#include <vector>

namespace relume {

// Weights vertices by the cost per vertex of their part: measured once enough of the part is baked; before
// that, the probed cost, scaled by how far probes were off so far.
class BakeEstimate {
  public:
    struct Part {
        uint64_t vertices = 0, doneBefore = 0; // doneBefore: found in a checkpoint
        double probedSeconds = 1;              // per vertex, from a probe before baking; only ratios matter
    };

    explicit BakeEstimate(std::vector<Part> parts);

    // Records that `vertices` more of a part were baked in `seconds`.
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
