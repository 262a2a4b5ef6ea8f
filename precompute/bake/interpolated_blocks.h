// Blocks that stand for those that are not baked yet.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/checkpoint.h"

namespace relume {

// Appends those of `blocks` that `interpolated` lacks: bakes one in twelve of their parts' vertices, fewer
// where their rows would take more than 256 MiB, and interpolates the others. They depend on the plan alone.
// Throws BakeStopped, Error; then nothing more can be baked of `plan`, whose occluder is borrowed.
void interpolateBlocks(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> blocks,
                       const BakeLimits& limits, Checkpoint& interpolated, BakeObserver& observer);

} // namespace relume
