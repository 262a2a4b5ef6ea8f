// The device passes that bake the vertices of one part, one batch per submission.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/baked_rows.h"
#include "precompute/bake/batch_plan.h"
#include "precompute/visibility/visibility.h"

#include <memory>
#include <span>

namespace relume {

// Whether the passes compute visibility, or are given it.
enum class VisibilitySource { Found, Given };

class PartPasses {
  public:
    // Takes a part with factored sets, of an asset with an occluder. The batch is planned from the limits of
    // the device and `limits` (batch_plan.h), and halved, with a warning, while memory does not suffice.
    // Throws vk::OutOfMemory or std::bad_alloc when not even one point fits. Keeps references to `asset` and
    // `part`, which must outlive it.
    PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
               const BakeOptions& options, const BakeLimits& limits = {},
               VisibilitySource source = VisibilitySource::Found);

    uint32_t batch() const { return mBatch; } // most points per submission

    // Bakes any number of points and appends their rows to `rows`, one per set; the result does not depend on
    // the batch. `given` holds the points' visibility bits if they are not computed here. `found`, if any,
    // has computed bits appended. After vk::OutOfMemory or std::bad_alloc, `rows` may be incomplete;
    // halveBatch() and try again.
    void bake(std::span<const shared::BakePoint> points, std::span<BakedRows> rows,
              std::span<const uint32_t> given = {}, std::vector<uint32_t>* found = nullptr);

    // Recreates everything for half the batch or less. Returns false if the batch is 1 already. `why` is
    // logged.
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
    std::unique_ptr<Visibility> mVisibility; // null if visibility is given
    std::vector<TransportPass> mTransports;  // one per set
    vk::Buffer mPoints, mBits;
    vk::Buffer mGivenBits, mFoundBits; // host-visible; empty if not needed
};

} // namespace relume
