// A loop on all processor cores, for what somebody waits for.
#pragma once

#include <cstddef>
#include <functional>

namespace relume {

// Calls work(0) to work(count - 1), each once and in any order, on this and other threads: as many as the
// processor has, or fewer if no more can be had. If a call throws, no further ones begin, and the first
// exception is rethrown.
void parallelFor(size_t count, const std::function<void(size_t)>& work);

} // namespace relume
