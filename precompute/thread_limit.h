// A limit on the processor cores that precomputation uses.
#pragma once

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

} // namespace relume
