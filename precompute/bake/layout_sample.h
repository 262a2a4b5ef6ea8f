// A sample of a bake's blocks, which tells how all are encoded.
#pragma once

#include "precompute/bake/block_baker.h"

namespace relume {

// Blocks spread evenly over the surface of every part, or of some where the parts are many, in their order:
// docs/layouts.md. They depend on the plan's options and numbers of vertices and terms alone.
std::vector<uint32_t> sampleBlocks(const BakePlan& plan);

struct SampledBlock {
    uint32_t block;
    BakedBlock baked; // visibility packed
};

// Bakes them, in a stage of its own, and sets the plan's scale. Throws BakeStopped, Error. `kept` as for
// bakeBlocks(); it serves the blocks alone, not the vertices besides that tell the sets' units.
std::vector<SampledBlock> bakeSample(const vk::Device& device, BakePlan& plan, const BakeLimits& limits,
                                     BakeObserver& observer, BakeTimes& times, KeptVisibility* kept);

} // namespace relume
