#include "engine/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace relume {

void parallelFor(size_t count, const std::function<void(size_t)>& work) {
    std::atomic<size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (size_t i; (i = next++) < count;) work(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    {
        const size_t most = std::min<size_t>(count, std::thread::hardware_concurrency());
        std::vector<std::jthread> threads; // joined at the end of the block
        try {
            while (threads.size() + 1 < most) threads.emplace_back(run);
        } catch (const std::system_error&) { // no more threads
        } catch (const std::bad_alloc&) {    // nor memory for them
        }
        run();
    }
    if (failure) std::rethrow_exception(failure);
}

} // namespace relume
