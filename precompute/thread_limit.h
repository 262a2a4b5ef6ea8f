// A limit on the processor cores that precomputation uses.
#pragma once

#include <cstddef>
#include <memory>

namespace relume {

// Limits TBB to `threads` threads while it exists, and Mesa's software device, if created after it, to as
// many.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();

  private:
    struct Control;
    std::unique_ptr<Control> mControl;
};

// Returns the number of threads that TBB's work from here may take, as limits on it allow.
size_t allowedThreads();

} // namespace relume
