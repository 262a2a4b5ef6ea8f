#include "precompute/bake/storing_sink.h"

#include <atomic>
#include <tbb/task_arena.h>

namespace relume {

struct StoringSink::Work {
    uint32_t block;
    BakedBlock baked;
    StoredBlock stored;
    std::atomic<bool> isDone = false;
};

StoringSink::StoringSink(const BakePlan& plan, Keep keep)
    : mPlan(plan), mKeep(std::move(keep)), mTasks(std::make_unique<tbb::task_group>()) {}

StoringSink::~StoringSink() {
    mTasks->cancel();
    try {
        mTasks->wait();
    } catch (...) { // whoever destroys it has an error of its own
    }
}

void StoringSink::keepFinished() {
    while (!mWorks.empty() && mWorks.front()->isDone) {
        const std::shared_ptr<Work> first = std::move(mWorks.front());
        mWorks.pop_front();
        mKeep(first->block, std::move(first->stored));
    }
}

void StoringSink::take(uint32_t block, BakedBlock baked) {
    keepFinished();
    // Blocks in hand are few, or memory would not be.
    if (mWorks.size() >= size_t(2 * tbb::this_task_arena::max_concurrency())) finish();
    const auto work = std::make_shared<Work>();
    work->block = block;
    work->baked = std::move(baked);
    mWorks.push_back(work);
    mTasks->run([this, work] {
        work->stored = storeBlock(mPlan, work->block, std::move(work->baked));
        work->isDone = true;
    });
}

void StoringSink::finish() {
    mTasks->wait();
    keepFinished();
}

} // namespace relume
