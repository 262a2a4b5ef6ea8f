// Progress of long work on stderr: a bar on a terminal, a line every 10 % elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace relume {

// Shows nothing for work that ends within two seconds. Not thread-safe: one thread reports.
class Progress {
  public:
    // `total` items of work; `unit` names them in the plural ("vertices").
    Progress(std::string_view title, uint64_t total, std::string unit, bool quiet = false);
    // Ends the line of an unfinished bar, clears a title without one.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Where work stands whose items differ in cost.
    struct State {
        uint64_t done;
        double fraction, perSecond, secondsLeft;
    };

    // Says that `done` items are finished.
    void update(uint64_t done);
    void update(const State& state);

    // The stage in hand: shown at once on a terminal.
    void setTitle(std::string_view title);

  private:
    void print(const State& state);

    std::string mTitle, mUnit;
    uint64_t mTotal;
    bool mQuiet, mTerminal, mLineOpen = false, mTitleOpen = false;
    uint64_t mNextTenth = 1;
    std::chrono::steady_clock::time_point mStart, mLastPrint;
};

} // namespace relume
