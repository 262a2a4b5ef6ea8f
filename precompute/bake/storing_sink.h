// From baked blocks to stored ones, beside the device.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/stored_blocks.h"

#include <deque>
#include <functional>
#include <memory>
#include <tbb/task_group.h>

namespace relume {

// Stores blocks on other threads while the next are baked, where more than one thread is allowed, and keeps
// them in their order. Blocks in hand are few, of at most `mostBytes` together, but for a single one.
class StoringSink : public BakeSink {
  public:
    // Called from the thread that bakes.
    using Keep = std::function<void(uint32_t block, StoredBlock stored)>;

    // A share of what a user lets a bake take (BakeLimits), or of what is right else.
    static uint64_t bytesInHand(const BakeLimits& limits);

    // `plan` outlives it.
    StoringSink(const BakePlan& plan, uint64_t mostBytes, Keep keep);
    // Drops what is not finished.
    ~StoringSink() override;

    // Throws what storing and keeping earlier ones do.
    void take(uint32_t block, BakedBlock baked) override;
    // All that can be stored is kept, whatever it throws.
    void finish() override;

  private:
    struct Work;
    void keepFinished();

    const BakePlan& mPlan;
    uint64_t mMostBytes, mBytes = 0; // of blocks in hand
    Keep mKeep;
    std::deque<std::shared_ptr<Work>> mWorks; // blocks as they came
    std::unique_ptr<tbb::task_group> mTasks;
};

} // namespace relume
