// From a scene to an asset, in memory or on disk.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/shard.h"

#include <filesystem>

namespace relume {

// Bakes every part in memory, for callers that use the asset at once. Vertices are put in bake order
// (vertex_order.h). The same scene, options and device give the same asset. Throws Error.
Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options);
Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer,
           BakeTimes* times = nullptr);

// What bakeToFile() made.
struct BakeSummary {
    uint64_t vertices = 0, resumed = 0; // of the shard, if any; resumed: found in the checkpoint
    BakeTimes times;                    // of this run
};

// The checkpoint of a bake to `output`.
std::filesystem::path checkpointPath(const std::filesystem::path& output);

// Bakes to a file of the bytes that encodeAsset(bake(…)) has, holding no more than a few blocks at a time.
// Finished blocks go to the checkpoint beside it, which a later call with the same scene, options and device
// goes on from; the file itself appears whole, after the last block, and the checkpoint goes. With a shard
// only its blocks are baked, and the file is one for mergeShards() (merge.h). Throws BakeStopped, Error; then
// the checkpoint stays and `output` is as it was.
BakeSummary bakeToFile(const vk::Device& device, Scene scene, const BakeOptions& options,
                       const std::filesystem::path& output, const BakeLimits& limits, BakeObserver& observer,
                       const std::optional<Shard>& shard = std::nullopt);

} // namespace relume
