// Threads in the place of TBB's, for the thread sanitizer: included before all else in builds with it. The
// sanitizer does not see how TBB's library, which is not instrumented, orders what its threads do. What runs
// in parallel is the same.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <thread>
#include <vector>

namespace tbb {

// Calls body(i) for each i from `first` to before `last`, each in one of the threads that TBB may use. Throws
// what the first failing call threw, after all threads have ended.
template <typename Index, typename Body>
void parallelForInThreads(Index first, Index last, const Body& body) {
    constexpr size_t kMostThreads = 4;
    if (!(first < last)) return;
    const size_t allowed =
        std::min(global_control::active_value(global_control::max_allowed_parallelism), kMostThreads);
    std::atomic<Index> next = first;
    std::mutex mutex; // guards failure
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            for (Index i = next++; i < last; i = next++) body(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            next = last;
        }
    };
    {
        std::vector<std::jthread> threads;
        for (size_t t = 1; t < std::min(allowed, size_t(last - first)); t++) threads.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

template <typename Value, typename Body>
void parallelForInThreads(const blocked_range<Value>& range, const Body& body) {
    constexpr size_t kPieces = 16;
    const size_t count = range.size();
    parallelForInThreads(size_t(0), std::min(count, kPieces), [&](size_t piece) {
        const size_t pieces = std::min(count, kPieces);
        body(blocked_range<Value>(Value(range.begin() + piece * count / pieces),
                                  Value(range.begin() + (piece + 1) * count / pieces)));
    });
}

// A task is a thread.
class ThreadGroup {
  public:
    template <typename Body>
    void run(Body body) {
        mThreads.emplace_back(std::move(body));
    }
    void wait() { mThreads.clear(); }
    void cancel() {} // what runs ends by itself

  private:
    std::vector<std::jthread> mThreads;
};

} // namespace tbb

#define parallel_for parallelForInThreads
#define task_group ThreadGroup
