// Rows of some vertices, which previews show in place of those that are not baked yet.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/stored_blocks.h"

#include <functional>

namespace relume {

// Rows of direct light of one vertex in twelve, fewer where they would take more than 256 MiB. What is
// interpolated from them depends on the plan alone.
class CoarseRows {
  public:
    // Bakes rows for the parts of `blocks`. Throws BakeStopped, Error; then nothing more can be baked of
    // `plan`, whose occluder is borrowed.
    CoarseRows(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> blocks,
               const BakeLimits& limits, BakeObserver& observer);

    // Gives to `store` each of `blocks` as the plan keeps it, with bounced light where it was found. Throws
    // BakeStopped, and what `store` throws.
    void interpolate(const BakePlan& plan, std::span<const uint32_t> blocks,
                     const std::function<void(uint32_t block, StoredBlock stored)>& store,
                     BakeObserver& observer) const;

    // Returns the most bytes that the interpolated rows of a plan's vertices take.
    static uint64_t interpolatedBytes(const BakePlan& plan);

  private:
    // The coarse vertices of a part; none of one that needs no blocks.
    struct Part {
        std::vector<uint32_t> vertices;
        float spacing = 1;
    };

    std::vector<Part> mParts;
    std::vector<BakedRows> mRows; // per set, over all parts
};

} // namespace relume
