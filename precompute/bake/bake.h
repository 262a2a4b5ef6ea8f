// Bakes a scene to an asset, in memory or on disk.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/shard.h"

#include <filesystem>

namespace relume {

// Bakes every part and returns the asset in memory. Vertices are put in bake order (vertex_order.h). The
// result depends only on scene, options and device. Throws Error.
Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options);
Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer,
           BakeTimes* times = nullptr);

// Optional outputs (one shard, or previews; not both) and a file whose visibility may be reused.
struct OutputOptions {
    std::optional<Shard> shard = std::nullopt; // bake only its blocks, to a file for mergeShards() (merge.h)
    bool previews = false; // write previews to the output until the bake is done (preview.h)
    // Reuses the visibility kept in this asset if its key matches; empty: that of the file being replaced.
    std::filesystem::path visibility = {};
};

// The result of bakeToFile().
struct BakeSummary {
    uint64_t vertices = 0, resumed = 0; // of the shard, if any; resumed: found in the checkpoint
    BakeTimes times;                    // of this run
    uint64_t bytes = 0;                 // that transport takes in memory; 0 for a shard
    TransportLayout kept{};             // the layout of transport
    std::optional<LayoutRecord> layout; // as recorded in the asset
};

// Returns the path of the checkpoint of a bake to `output`.
std::filesystem::path checkpointPath(const std::filesystem::path& output);
// Returns the path of the checkpoint-like file that holds the blocks interpolated for previews.
std::filesystem::path interpolatedPath(const std::filesystem::path& output);

// Bakes to a file that is byte for byte encodeAsset(bake(…)), holding no more than a few blocks in memory.
// Finished blocks are appended to the checkpoint beside it, from which a later call with the same scene,
// options and device resumes. After the last block the file is written whole and the checkpoint deleted.
// Visibility with the right key, kept in `output` or in outputOptions.visibility, is reused; the log says so.
// Throws BakeStopped and Error; the checkpoint then remains, and `output` is as before or, with previews, the
// last preview.
BakeSummary bakeToFile(const vk::Device& device, Scene scene, const BakeOptions& options,
                       const std::filesystem::path& output, const BakeLimits& limits, BakeObserver& observer,
                       const OutputOptions& outputOptions = {});

// Bakes the asset `skeleton`, read without rows, anew from its kept visibility, with `materials` and
// `options` as planRebake() takes them; the file is the one bakeToFile() would write. `output` may be the
// asset itself. Throws as bakeToFile(), and Error when `kept` was not computed for these meshes by this
// program on this device.
BakeSummary rebakeToFile(const vk::Device& device, KeptVisibility& kept, Asset skeleton,
                         const std::vector<std::string>& materials, const BakeOptions& options,
                         const std::filesystem::path& output, const BakeLimits& limits,
                         BakeObserver& observer);

} // namespace relume
