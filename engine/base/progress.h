// Progress of long work on stderr: a bar on a terminal, otherwise a line every 10 %.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace relume {

// Shows progress, but nothing in the first two seconds. Not thread-safe: one thread reports.
class Progress {
  public:
    // `total` counts the items of work; `unit` is their plural ("vertices"). `quiet` shows nothing.
    Progress(std::string_view title, uint64_t total, std::string unit, bool quiet = false);
    // Ends the line of an unfinished bar; clears a title shown without a bar.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // The state of work whose items differ in cost, so that the count alone does not give fraction and rate.
    struct State {
        uint64_t done;
        double fraction, perSecond, secondsLeft;
    };

    // Reports that `done` items are finished.
    void update(uint64_t done);
    void update(const State& state);

    // Corrects the number of items where it is an estimate.
    void setTotal(uint64_t total) { mTotal = total; }

    // Sets the name of the current stage. On a terminal it is shown at once, or with the bar's next update.
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
