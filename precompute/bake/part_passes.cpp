#include "precompute/bake/part_passes.h"

#include "engine/vk/result.h"

#include <algorithm>
#include <spdlog/spdlog.h>

namespace relume {

PartPasses::PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
                       const BakeOptions& options, const BakeLimits& limits)
    : mDevice(device), mAsset(asset), mPart(part), mOptions(options), mCommands(device, "bake") {
    int terms = 0;
    for (const MaterialSet& set : part.sets) terms += set.brdf.terms;
    mBatch = std::min(planBatch(device, options, terms, limits), uint32_t(part.mesh.vertexCount()));
    try {
        create();
    } catch (const vk::OutOfMemory& failure) {
        if (!halveBatch(failure.what())) throw;
    } catch (const std::bad_alloc&) {
        if (!halveBatch("out of host memory")) throw;
    }
}

bool PartPasses::halveBatch(const std::string& why) {
    std::string reason = why;
    while (mBatch > 1) {
        spdlog::warn("{}; going on with batches of {} vertices instead of {}", reason, mBatch / 2, mBatch);
        mBatch /= 2;
        vkDeviceWaitIdle(mDevice.handle()); // a failed submission may still hold what is about to go
        try {
            create();
            return true;
        } catch (const vk::OutOfMemory& failure) {
            reason = failure.what();
        } catch (const std::bad_alloc&) {
            reason = "out of host memory";
        }
    }
    return false;
}

void PartPasses::create() {
    const auto size = uint32_t(mOptions.visibilitySize);
    mTransports.clear();
    mVisibility.reset();
    mPoints = {};
    mBits = {};
    mVisibility = makeVisibility(mDevice, *mOptions.visibilityMethod, mAsset.occluder, size, mBatch,
                                 visibilityNearDistance(mAsset.visibilityOffset));
    mPoints = {mDevice, mBatch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points"};
    mBits = {mDevice, mBatch * visibilityBytes(size), vk::BufferUse::Device, "visibility bits"};
    for (const MaterialSet& set : mPart.sets) mTransports.emplace_back(mDevice, set.brdf, mOptions, mBatch);
}

void PartPasses::bake(std::span<const shared::BakePoint> points, std::span<BakedRows> rows) {
    RELUME_CHECK_EQ(rows.size(), mTransports.size());
    while (!points.empty()) {
        const auto count = uint32_t(std::min(size_t(mBatch), points.size()));
        std::ranges::copy(points.first(count), mPoints.map<shared::BakePoint>().begin());
        mCommands.begin();
        mVisibility->record(mCommands, mPoints, count, mBits);
        for (const TransportPass& transport : mTransports) transport.record(mCommands, mPoints, count, mBits);
        mCommands.submitAndWait();
        mVisibility->check();
        for (size_t set = 0; set < mTransports.size(); set++) {
            mTransports[set].collect(count, rows[set].transport, rows[set].losses);
            rows[set].transport.vertices += count;
        }
        points = points.subspan(count);
    }
}

} // namespace relume
