// The device passes that bake the vertices of one part, a batch a submission.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/baked_rows.h"
#include "precompute/bake/batch_plan.h"
#include "precompute/visibility/visibility.h"

#include <memory>
#include <span>

namespace relume {

class PartPasses {
  public:
    // For a part whose sets are factored, of an asset whose occluder is made. The batch is planned from the
    // device's limits and `limits` (batch_plan.h), and halved as often as memory asks for, saying so. Throws
    // vk::OutOfMemory or std::bad_alloc when not even one point fits. `asset` and `part` must outlive it.
    PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
               const BakeOptions& options, const BakeLimits& limits = {});

    uint32_t batch() const { return mBatch; } // most points of a submission

    // Bakes any number of points. Appends their rows to `rows`, one per set: the same for any batch. After an
    // OutOfMemory or std::bad_alloc `rows` may hold some of them; halveBatch() and another try may do.
    void bake(std::span<const shared::BakePoint> points, std::span<BakedRows> rows);

    // Makes everything anew for half the batch or less. False if it is 1. `why` is for the log.
    bool halveBatch(const std::string& why);

    const vk::PassTimes& times() const { return mCommands.times(); }

  private:
    void create();

    const vk::Device& mDevice;
    const Asset& mAsset;
    const AssetPart& mPart;
    BakeOptions mOptions;
    vk::Commands mCommands;
    uint32_t mBatch;
    std::unique_ptr<Visibility> mVisibility;
    std::vector<TransportPass> mTransports; // per set
    vk::Buffer mPoints, mBits;
};

} // namespace relume
