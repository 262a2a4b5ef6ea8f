#include "precompute/bake/part_passes.h"

#include "engine/vk/result.h"
#include "precompute/bake/batch_plan.h"

#include <algorithm>
#include <spdlog/spdlog.h>

namespace relume {

PartPasses::PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
                       const BakeOptions& options)
    : mDevice(device), mCommands(device, "bake") {
    int terms = 0;
    for (const MaterialSet& set : part.sets) terms += set.brdf.terms;
    mBatch = std::min(planBatch(device, options, terms), uint32_t(part.mesh.vertexCount()));
    for (;; mBatch /= 2) {
        try {
            create(asset, part, options);
            return;
        } catch (const vk::OutOfMemory& failure) {
            if (mBatch <= 1) throw;
            spdlog::warn("{}; going on with batches of {} vertices instead of {}", failure.what(), mBatch / 2,
                         mBatch);
        }
    }
}

void PartPasses::create(const Asset& asset, const AssetPart& part, const BakeOptions& options) {
    const auto size = uint32_t(options.visibilitySize);
    mTransports.clear();
    mVisibility.reset();
    mVisibility = makeVisibility(mDevice, options.visibilityMethod, asset.occluder, size, mBatch,
                                 visibilityNearDistance(asset.visibilityOffset));
    mPoints = {mDevice, mBatch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points"};
    mBits = {mDevice, mBatch * visibilityBytes(size), vk::BufferUse::Device, "visibility bits"};
    for (const MaterialSet& set : part.sets) mTransports.emplace_back(mDevice, set.brdf, options, mBatch);
}

void PartPasses::bake(std::span<const shared::BakePoint> points, std::span<SparseTransport* const> transports,
                      TransportLosses& losses) {
    RELUME_CHECK_EQ(transports.size(), mTransports.size());
    while (!points.empty()) {
        const auto count = uint32_t(std::min(size_t(mBatch), points.size()));
        std::ranges::copy(points.first(count), mPoints.map<shared::BakePoint>().begin());
        mCommands.begin();
        mVisibility->record(mCommands, mPoints, count, mBits);
        for (const TransportPass& transport : mTransports) transport.record(mCommands, mPoints, count, mBits);
        mCommands.submitAndWait();
        mVisibility->check();
        for (size_t set = 0; set < mTransports.size(); set++)
            mTransports[set].collect(count, *transports[set], losses);
        points = points.subspan(count);
    }
}

} // namespace relume
