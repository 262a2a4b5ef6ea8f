// Measures elapsed time.
#pragma once

#include <chrono>
#include <utility>

namespace relume {

// Runs from its construction, on a clock that never goes back.
class Stopwatch {
  public:
    // Returns the seconds since construction or the last restart().
    double seconds() const { return std::chrono::duration<double>(Clock::now() - mStart).count(); }

    // Begins anew at zero. Returns the seconds before that.
    double restart() {
        const Clock::time_point now = Clock::now();
        return std::chrono::duration<double>(now - std::exchange(mStart, now)).count();
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point mStart = Clock::now();
};

} // namespace relume
