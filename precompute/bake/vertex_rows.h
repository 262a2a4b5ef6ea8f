// Rows of some vertices, wherever they are.
#pragma once

#include "precompute/bake/block_baker.h"

#include <functional>

namespace relume {

// Most bytes that the rows of a vertex of this part take in memory, with what they lost.
uint64_t rowBytes(const Asset& asset, const AssetPart& part);

// Of the next vertices of a part: rows, per set.
using TakeRows = std::function<void(uint32_t part, std::span<const BakedRows> sets)>;

// Bakes these vertices of every part, one list a part, part after part and vertex after vertex. Throws
// BakeStopped, Error; then nothing more can be baked of `plan`, whose occluder is borrowed.
void bakeVertices(const vk::Device& device, BakePlan& plan, std::span<const std::vector<uint32_t>> vertices,
                  const BakeLimits& limits, const TakeRows& take, BakeObserver& observer, BakeTimes& times);

} // namespace relume
