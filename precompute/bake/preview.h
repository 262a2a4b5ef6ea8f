// Images of the whole while it is being baked.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/checkpoint.h"

#include <functional>

namespace relume {

// Writes the asset of these blocks, all of the plan's.
using PreviewWriter = std::function<void(const StoredBlocks& blocks)>;

// The blocks in portions, to be baked one after the other, each spread evenly over the surfaces; at most
// four.
std::vector<std::vector<uint32_t>> previewPortions(const BakePlan& plan, std::span<const uint32_t> blocks);

// Bakes `missing`, the blocks that `checkpoint` lacks, into `sink`, which puts them there. Before that, and
// after every portion but the last as far as writing takes little of the time, it writes a preview: of
// blocks that are baked, and interpolated ones for the others, which are kept in `interpolated`. `kept` as
// for bakeBlocks(), not for a plan that keeps visibility. Throws BakeStopped, Error.
void bakeWithPreviews(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> missing,
                      const BakeLimits& limits, const Checkpoint& checkpoint, Checkpoint& interpolated,
                      BakeSink& sink, const PreviewWriter& write, BakeObserver& observer, BakeTimes& times,
                      KeptVisibility* kept);

} // namespace relume
