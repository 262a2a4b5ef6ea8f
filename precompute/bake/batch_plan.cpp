#include "precompute/bake/batch_plan.h"

#include "precompute/bake/transport_pass.h"
#include "precompute/visibility/visibility.h"

#include <algorithm>

namespace relume {

uint32_t planBatch(const vk::Device& device, const BakeOptions& options, int terms) {
    const auto size = uint64_t(options.visibilitySize);
    const uint64_t blockedBytes = 6 * size * size; // one byte a texel, before packing
    // A quarter of the largest heap, and never more than 1 GiB: the rest belongs to others.
    const uint64_t memory = std::min<uint64_t>(device.info().largestHeap / 4, 1ull << 30);
    const uint64_t bytesPerPoint =
        2 * blockedBytes + visibilityBytes(uint32_t(size)) + TransportPass::bytesPerPoint(terms, options);
    const uint64_t batch = std::min({uint64_t(kMaxBatch), uint64_t(device.info().largestLayerCount / 6),
                                     device.largestStorageBuffer() / blockedBytes, memory / bytesPerPoint,
                                     uint64_t(TransportPass::largestBatch(device, options))});
    return uint32_t(std::max<uint64_t>(batch, 1));
}

} // namespace relume
