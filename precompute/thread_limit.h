// How many processor cores precomputation takes.
#pragma once

#include <memory>

namespace relume {

// While it lives, at most `threads` of the host's threads work at a time: TBB's, and Mesa's software device's
// if that is made meanwhile.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();

  private:
    struct Control;
    std::unique_ptr<Control> mControl;
};

} // namespace relume
