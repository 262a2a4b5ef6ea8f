// From baked blocks to stored ones, beside the device.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/stored_blocks.h"

#include <deque>
#include <functional>
#include <memory>
#include <tbb/task_group.h>

namespace relume {

// Stores blocks on other threads while the next are baked, and keeps them in their order.
class StoringSink : public BakeSink {
  public:
    // Called from the thread that bakes.
    using Keep = std::function<void(uint32_t block, StoredBlock stored)>;

    // `plan` outlives it.
    StoringSink(const BakePlan& plan, Keep keep);
    // Drops what is not finished.
    ~StoringSink() override;

    // Throws what storing and keeping earlier ones do.
    void take(uint32_t block, BakedBlock baked) override;
    void finish() override;

  private:
    struct Work;
    void keepFinished();

    const BakePlan& mPlan;
    Keep mKeep;
    std::deque<std::shared_ptr<Work>> mWorks; // blocks as they came
    std::unique_ptr<tbb::task_group> mTasks;
};

} // namespace relume
