#include "precompute/bake/storing_sink.h"

#include "precompute/thread_limit.h"

#include <algorithm>
#include <atomic>
#include <exception>

namespace relume {

namespace {

// Returns the approximate size of a baked block in memory.
uint64_t bytesOf(const BakedBlock& baked) {
    uint64_t bytes = baked.visibility.size() * sizeof(uint32_t);
    for (const BakedRows& set : baked.sets)
        bytes += set.transport.entries() * (sizeof(uint16_t) + sizeof(uint32_t)) +
                 set.transport.rows() * (sizeof(float) + sizeof(uint64_t) + sizeof(TransportLosses));
    for (const StoredChunk& chunk : baked.packedVisibility) bytes += chunk.bytes.size();
    return bytes;
}

} // namespace

struct StoringSink::Work {
    uint32_t block;
    BakedBlock baked;
    uint64_t bytes; // of `baked`
    StoredBlock stored;
    std::exception_ptr error; // set instead of `stored` on failure
    std::atomic<bool> isDone = false;
};

uint64_t StoringSink::bytesInHand(const BakeLimits& limits) {
    constexpr uint64_t kUsual = uint64_t(256) << 20, kShare = 4;
    return limits.memory == 0 ? kUsual : std::min(kUsual, limits.memory / kShare);
}

StoringSink::StoringSink(const BakePlan& plan, uint64_t mostBytes, Keep keep)
    : mPlan(plan), mMostBytes(mostBytes), mKeep(std::move(keep)),
      mTasks(std::make_unique<tbb::task_group>()) {}

StoringSink::~StoringSink() {
    mTasks->cancel();
    try {
        mTasks->wait();
    } catch (...) { // whoever destroys this is handling an error already
    }
}

void StoringSink::keepFinished() {
    while (!mWorks.empty() && mWorks.front()->isDone) {
        const std::shared_ptr<Work> first = std::move(mWorks.front());
        mWorks.pop_front();
        mBytes -= first->bytes;
        if (first->error) std::rethrow_exception(first->error);
        mKeep(first->block, std::move(first->stored));
    }
}

void StoringSink::take(uint32_t block, BakedBlock baked) {
    keepFinished();
    const size_t threads = allowedThreads();
    const uint64_t bytes = bytesOf(baked);
    if (mWorks.size() >= 2 * threads || mBytes + bytes > mMostBytes) finish();
    if (threads == 1) {
        mKeep(block, storeBlock(mPlan, block, std::move(baked)));
        return;
    }
    const auto work = std::make_shared<Work>();
    work->block = block;
    work->baked = std::move(baked);
    work->bytes = bytes;
    mBytes += bytes;
    mWorks.push_back(work);
    mTasks->run([this, work] {
        try {
            work->stored = storeBlock(mPlan, work->block, std::move(work->baked));
        } catch (...) { // must not cancel the other tasks
            work->error = std::current_exception();
        }
        work->isDone = true;
    });
}

void StoringSink::finish() {
    mTasks->wait();
    std::exception_ptr first;
    while (!mWorks.empty()) // all are done
        try {
            keepFinished();
        } catch (...) {
            if (!first) first = std::current_exception();
        }
    if (first) std::rethrow_exception(first);
}

} // namespace relume
