// Bakes a sample of blocks, from which the encoding of all blocks is determined.
#pragma once

#include "precompute/bake/block_baker.h"

namespace relume {

// Returns, in order, blocks spread evenly over every part, or over some if there are many parts
// (docs/layouts.md). The choice depends only on the plan's options and its numbers of vertices and terms.
std::vector<uint32_t> sampleBlocks(const BakePlan& plan);

struct SampledBlock {
    uint32_t block;
    BakedBlock baked; // visibility is packed
};

// Bakes the sample, as a stage of its own, and sets the plan's scale. `kept` is as for bakeBlocks(); it
// serves the blocks, but not the additional vertices that determine the sets' normalization. Throws
// BakeStopped and Error.
std::vector<SampledBlock> bakeSample(const vk::Device& device, BakePlan& plan, const BakeLimits& limits,
                                     BakeObserver& observer, BakeTimes& times, KeptVisibility* kept);

} // namespace relume
