// Rows of some vertices, wherever they are.
#pragma once

#include "precompute/bake/block_baker.h"

namespace relume {

// Bakes these vertices of every part, one list a part, and gives a BakedRows per set over all parts, vertex
// after vertex. Throws BakeStopped, Error; then nothing more can be baked of `plan`, whose occluder is
// borrowed.
std::vector<BakedRows> bakeVertices(const vk::Device& device, BakePlan& plan,
                                    std::span<const std::vector<uint32_t>> vertices, const BakeLimits& limits,
                                    BakeObserver& observer);

} // namespace relume
