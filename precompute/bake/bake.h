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

// What bakeToFile() writes, beside or instead of the whole bake: not both. And what it need not find.
struct OutputOptions {
    std::optional<Shard> shard = std::nullopt; // its blocks alone: a file for mergeShards() (merge.h)
    bool previews = false;                     // until the bake is done (preview.h)
    // A bake that may keep the visibility of these very vertices; empty: the file that is written over.
    std::filesystem::path visibility = {};
};

// What bakeToFile() made.
struct BakeSummary {
    uint64_t vertices = 0, resumed = 0; // of the shard, if any; resumed: found in the checkpoint
    BakeTimes times;                    // of this run
    uint64_t bytes = 0;                 // of transport in memory; 0 of a shard
    TransportLayout kept{};
    std::optional<LayoutRecord> layout; // as the asset has it
};

// The checkpoint of a bake to `output`.
std::filesystem::path checkpointPath(const std::filesystem::path& output);
// A file like it, of blocks that were interpolated for previews.
std::filesystem::path interpolatedPath(const std::filesystem::path& output);

// Bakes to a file of the bytes that encodeAsset(bake(…)) has, holding no more than a few blocks at a time.
// Finished blocks go to the checkpoint beside it, which a later call with the same scene, options and device
// goes on from; the file itself appears whole, after the last block, and the checkpoint goes. With a shard
// only its blocks are baked, and the file is one for mergeShards() (merge.h). Throws BakeStopped, Error; then
// the checkpoint stays and `output` is as it was, or with previews the last of these. Visibility that
// `output`, or the file that outputOptions.visibility names, keeps of the same key is not found again; the
// log says so.
BakeSummary bakeToFile(const vk::Device& device, Scene scene, const BakeOptions& options,
                       const std::filesystem::path& output, const BakeLimits& limits, BakeObserver& observer,
                       const OutputOptions& outputOptions = {});

// The same for a bake that keeps its visibility: to the file that bakeToFile() makes of its inputs with these
// materials and options, as planRebake() takes them. `output` may be the bake itself. Throws also when the
// kept visibility is not that of the bake on this device by this program.
BakeSummary rebakeToFile(const vk::Device& device, KeptVisibility& kept, Asset skeleton,
                         const std::vector<std::string>& materials, const BakeOptions& options,
                         const std::filesystem::path& output, const BakeLimits& limits,
                         BakeObserver& observer);

} // namespace relume
