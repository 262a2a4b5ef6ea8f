// Encodes baked blocks on the host while the device bakes the next.
#pragma once

#include "precompute/bake/block_baker.h"
#include "precompute/bake/stored_blocks.h"

#include <deque>
#include <functional>
#include <memory>
#include <tbb/task_group.h>

namespace relume {

// Encodes and compresses blocks on other threads, if more than one is allowed, and passes them on in order.
// At most two blocks per thread are pending, of at most `mostBytes` together unless a single one is larger.
class StoringSink : public BakeSink {
  public:
    // Receives a stored block; called from the thread that bakes.
    using Keep = std::function<void(uint32_t block, StoredBlock stored)>;

    // Returns the bytes that pending blocks may take: 256 MiB, or a quarter of the memory that `limits` allow
    // if less.
    static uint64_t bytesInHand(const BakeLimits& limits);

    // Keeps a reference to `plan`, which must outlive it.
    StoringSink(const BakePlan& plan, uint64_t mostBytes, Keep keep);
    // Drops blocks that are pending.
    ~StoringSink() override;

    // Throws what storing and keeping earlier blocks threw.
    void take(uint32_t block, BakedBlock baked) override;
    // Waits for pending blocks and keeps all that could be stored, then throws the first error.
    void finish() override;

  private:
    struct Work;
    void keepFinished();

    const BakePlan& mPlan;
    uint64_t mMostBytes, mBytes = 0; // mBytes: of pending blocks
    Keep mKeep;
    std::deque<std::shared_ptr<Work>> mWorks; // pending blocks, in order of arrival
    std::unique_ptr<tbb::task_group> mTasks;
};

} // namespace relume
