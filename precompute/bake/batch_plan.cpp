#include "precompute/bake/batch_plan.h"

#include "engine/base/error.h"
#include "precompute/bake/transport_pass.h"
#include "precompute/visibility/visibility.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

// Larger batches keep no device busier: a software device runs 1,500 subgroups per point, a large GPU has
// room for some ten thousand. A bake stops only between submissions.
constexpr uint64_t kMostSoftwarePoints = 64, kMostPoints = 256;

// Host memory per row entry while rows are collected, cut into blocks, encoded and compressed.
constexpr uint64_t kHostBytesPerEntry = 32;

uint32_t planBatch(const vk::Device& device, const BakeOptions& options, int terms, uint64_t entries,
                   const BakeLimits& limits) {
    const auto size = uint64_t(options.visibilitySize);
    // The layers of the rasterizer take a byte per texel before packing.
    const bool isDrawn = options.visibilityMethod != VisibilityMethod::Traced;
    const uint64_t blockedBytes = isDrawn ? 6 * size * size : 0;
    const uint32_t layers = device.info().outputsLayers ? device.info().largestLayerCount : UINT32_MAX;
    const uint64_t drawnPoints =
        std::min(layers / 6, uint32_t(device.largestStorageBuffer() / (6 * size * size)));
    // A quarter of the largest heap, at most 1 GiB; the rest is left to others.
    uint64_t memory = std::min<uint64_t>(device.info().largestHeap / 4, 1ull << 30);
    if (limits.memory > 0) memory = std::min(memory, limits.memory);
    // Kept visibility is in memory as read back, in the block, and encoded.
    const uint64_t copies = options.keepVisibility ? 4 : 1;
    const uint64_t bytesPerPoint = 2 * blockedBytes + copies * visibilityBytes(uint32_t(size)) +
                                   TransportPass::bytesPerPoint(terms, entries, options) +
                                   entries * kHostBytesPerEntry;
    if (limits.memory > 0 && limits.memory < bytesPerPoint)
        throw UsageError(
            fmt::format("--memory: expected at least the {} KiB that baking one vertex at a time takes, "
                        "found {} KiB",
                        (bytesPerPoint + 1023) / 1024, limits.memory / 1024));
    const uint64_t batch = std::min({device.info().isSoftware ? kMostSoftwarePoints : kMostPoints,
                                     isDrawn ? drawnPoints : kMostPoints, memory / bytesPerPoint,
                                     uint64_t(TransportPass::largestBatch(device, options))});
    return uint32_t(std::max<uint64_t>(batch, 1));
}

} // namespace relume
