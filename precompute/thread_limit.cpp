#include "precompute/thread_limit.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace relume {

struct ThreadLimit::Control {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : mControl(new Control{{tbb::global_control::max_allowed_parallelism, size_t(threads)}}) {
    // Mesa does not count the submitting thread, which waits for the others; with 0, that thread does the
    // work.
    setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 1);
}

ThreadLimit::~ThreadLimit() = default;

size_t allowedThreads() {
    const size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(allowed, size_t(tbb::this_task_arena::max_concurrency()));
}

} // namespace relume
