// Bakes rows of arbitrary vertices.
#pragma once

#include "precompute/bake/block_baker.h"

#include <functional>

namespace relume {

// Returns the bytes of memory that rows with this many entries in all take, with their losses.
uint64_t rowBytes(int rows, uint64_t entries);

// Receives the rows, per set, of the next vertices of a part.
using TakeRows = std::function<void(uint32_t part, std::span<const BakedRows> sets)>;

// Bakes `vertices` (a list per part) in order and passes their rows to `take`. Throws BakeStopped and Error;
// `plan`, whose occluder is moved out meanwhile, is then unusable.
void bakeVertices(const vk::Device& device, BakePlan& plan, std::span<const std::vector<uint32_t>> vertices,
                  const BakeLimits& limits, const TakeRows& take, BakeObserver& observer, BakeTimes& times);

} // namespace relume
