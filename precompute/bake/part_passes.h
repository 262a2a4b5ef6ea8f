// The device passes that bake the vertices of one part, a batch a submission.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/baked_rows.h"
#include "precompute/bake/batch_plan.h"
#include "precompute/visibility/visibility.h"

#include <memory>
#include <span>

namespace relume {

// Whether visibility is found by the passes, or was found before and is given to them.
enum class VisibilitySource { Found, Given };

class PartPasses {
  public:
    // For a part whose sets are factored, of an asset whose occluder is made. The batch is planned from the
    // device's limits and `limits` (batch_plan.h), and halved as often as memory asks for, saying so. Throws
    // vk::OutOfMemory or std::bad_alloc when not even one point fits. `asset` and `part` must outlive it.
    PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
               const BakeOptions& options, const BakeLimits& limits = {},
               VisibilitySource source = VisibilitySource::Found);

    uint32_t batch() const { return mBatch; } // most points of a submission

    // Bakes any number of points. Appends their rows to `rows`, one per set: the same for any batch. After an
    // OutOfMemory or std::bad_alloc `rows` may hold some of them; halveBatch() and another try may do.
    // `given`: the points' visibility bits, where it is not found here. `found`: these are appended to it.
    void bake(std::span<const shared::BakePoint> points, std::span<BakedRows> rows,
              std::span<const uint32_t> given = {}, std::vector<uint32_t>* found = nullptr);

    // Makes everything anew for half the batch or less. False if it is 1. `why` is for the log.
    bool halveBatch(const std::string& why);

    const vk::PassTimes& times() const { return mCommands.times(); }

  private:
    void create();
    void recordVisibility(uint32_t count);

    const vk::Device& mDevice;
    const Asset& mAsset;
    const AssetPart& mPart;
    BakeOptions mOptions;
    vk::Commands mCommands;
    uint32_t mBatch;
    VisibilitySource mSource;
    std::unique_ptr<Visibility> mVisibility; // where it is found here
    std::vector<TransportPass> mTransports;  // per set
    vk::Buffer mPoints, mBits;
    vk::Buffer mGivenBits, mFoundBits; // on the host, where they are given, or wanted
};

} // namespace relume
