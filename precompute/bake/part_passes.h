// The device passes that bake the vertices of one part, a batch a submission.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/transport_pass.h"
#include "precompute/visibility/visibility.h"

#include <memory>
#include <span>

namespace relume {

class PartPasses {
  public:
    // For a part whose sets are factored, of an asset whose occluder is made. The batch is planned from the
    // device's limits (batch_plan.h) and halved as often as its memory asks for, saying so. Throws
    // vk::OutOfMemory when not even one point fits.
    PartPasses(const vk::Device& device, const Asset& asset, const AssetPart& part,
               const BakeOptions& options);

    uint32_t batch() const { return mBatch; } // most points of a submission

    // Bakes any number of points. Appends their rows to `transports`, one per set, and adds up `losses` row
    // by row: the same for any batch.
    void bake(std::span<const shared::BakePoint> points, std::span<SparseTransport* const> transports,
              TransportLosses& losses);

    const vk::PassTimes& times() const { return mCommands.times(); }

  private:
    void create(const Asset& asset, const AssetPart& part, const BakeOptions& options);

    const vk::Device& mDevice;
    vk::Commands mCommands;
    uint32_t mBatch;
    std::unique_ptr<Visibility> mVisibility;
    std::vector<TransportPass> mTransports; // per set
    vk::Buffer mPoints, mBits;
};

} // namespace relume
