#include "precompute/bake/part_passes.h"

#include "engine/base/log.h"
#include "engine/vk/result.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

PartPasses::PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
                       const BakeOptions& options, const BakeLimits& limits, VisibilitySource source)
    : mDevice(device), mAsset(asset), mPart(part), mOptions(options), mCommands(device, "bake"),
      mSource(source) {
    mBatch = std::min(planBatch(device, options, termCount(part), rowEntries(asset, part), limits),
                      uint32_t(part.mesh.vertexCount()));
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
        log(LogLevel::Warning, fmt::format("{}; going on with batches of {} vertices instead of {}", reason,
                                           mBatch / 2, mBatch));
        mBatch /= 2;
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
    mGivenBits = {};
    mFoundBits = {};
    const uint64_t bitBytes = mBatch * visibilityBytes(size);
    if (mSource == VisibilitySource::Found)
        mVisibility = makeVisibility(mDevice, mOptions.visibilityMethod, mAsset.occluder, size, mBatch,
                                     visibilityNearDistance(mAsset.visibilityOffset));
    else
        mGivenBits = {mDevice, bitBytes, vk::BufferUse::Upload, "given visibility bits"};
    if (mSource == VisibilitySource::Found && mOptions.keepVisibility)
        mFoundBits = {mDevice, bitBytes, vk::BufferUse::Readback, "found visibility bits"};
    mPoints = {mDevice, mBatch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points"};
    mBits = {mDevice, bitBytes, vk::BufferUse::Device, "visibility bits"};
    for (const MaterialSet& set : mPart.sets) {
        BakeOptions options = mOptions;
        options.coefficients = rowEntries(mAsset, set);
        mTransports.emplace_back(mDevice, set.brdf, options, mBatch);
    }
}

void PartPasses::recordVisibility(uint32_t count) {
    using enum vk::Stage;
    const uint64_t bytes = count * visibilityBytes(uint32_t(mOptions.visibilitySize));
    if (mVisibility) mVisibility->record(mCommands, mPoints, count, mBits);
    if (mSource == VisibilitySource::Given)
        mCommands.pass("visibility upload", [&] {
            mCommands.barrier(Compute, Transfer);
            mCommands.copy(mGivenBits, mBits, bytes);
            mCommands.barrier(Transfer, Compute);
        });
    else if (mOptions.keepVisibility)
        mCommands.pass("visibility download", [&] {
            mCommands.barrier(Compute, Transfer);
            mCommands.copy(mBits, mFoundBits, bytes);
            mCommands.barrier(Transfer, Host);
        });
}

void PartPasses::bake(std::span<const shared::BakePoint> points, std::span<BakedRows> rows,
                      std::span<const uint32_t> given, std::vector<uint32_t>* found) {
    RELUME_CHECK_EQ(rows.size(), mTransports.size());
    RELUME_CHECK(!found || (mOptions.keepVisibility && mSource == VisibilitySource::Found));
    const size_t pointWords = visibilityBytes(uint32_t(mOptions.visibilitySize)) / 4;
    RELUME_CHECK_EQ(given.size(), mSource == VisibilitySource::Given ? points.size() * pointWords : 0);
    while (!points.empty()) {
        const auto count = uint32_t(std::min(size_t(mBatch), points.size()));
        std::ranges::copy(points.first(count), mPoints.map<shared::BakePoint>().begin());
        if (!given.empty()) {
            std::ranges::copy(given.first(count * pointWords), mGivenBits.map<uint32_t>().begin());
            given = given.subspan(count * pointWords);
        }
        mCommands.begin();
        recordVisibility(count);
        for (const TransportPass& transport : mTransports) transport.record(mCommands, mPoints, count, mBits);
        mCommands.submitAndWait();
        if (mVisibility) mVisibility->check();
        if (found) {
            const auto bits = mFoundBits.map<uint32_t>().first(count * pointWords);
            found->insert(found->end(), bits.begin(), bits.end());
        }
        for (size_t set = 0; set < mTransports.size(); set++) {
            mTransports[set].collect(count, rows[set].transport, rows[set].losses);
            rows[set].transport.vertices += count;
        }
        points = points.subspan(count);
    }
}

} // namespace relume
