#include "engine/base/progress.h"

#include "engine/base/printable.h"

#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <unistd.h>

namespace relume {

using Clock = std::chrono::steady_clock;

namespace {

constexpr double kSilentSeconds = 2;
constexpr double kRedrawSeconds = 0.1;

double secondsBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

std::string durationText(double seconds) {
    const auto whole = int64_t(seconds + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

} // namespace

Progress::Progress(std::string_view title, uint64_t total, std::string unit, bool quiet)
    : mTitle(printable(title)), mUnit(std::move(unit)), mTotal(total), mQuiet(quiet),
      mTerminal(isatty(STDERR_FILENO) != 0), mStart(Clock::now()), mLastPrint(mStart) {}

Progress::~Progress() {
    if (mTitleOpen)
        fmt::print(stderr, "\r\033[K");
    else if (mLineOpen)
        fmt::print(stderr, "\n");
}

void Progress::update(uint64_t done) {
    if (mTotal == 0) return;
    const double seconds = secondsBetween(mStart, Clock::now());
    const double fraction = double(done) / double(mTotal);
    update({done, fraction, seconds > 0 ? double(done) / seconds : 0,
            done > 0 ? seconds / fraction - seconds : 0});
}

void Progress::update(const State& state) {
    if (mQuiet || mTotal == 0) return;
    const Clock::time_point now = Clock::now();
    if (secondsBetween(mStart, now) < kSilentSeconds) return;
    if (mTerminal) {
        if (state.done < mTotal && secondsBetween(mLastPrint, now) < kRedrawSeconds) return;
    } else {
        const auto tenths = uint64_t(state.fraction * 10);
        mNextTenth = std::min(mNextTenth, tenths + 1); // less where the total turned out to be larger
        if (tenths < mNextTenth) return;
        mNextTenth = tenths + 1;
    }
    mLastPrint = now;
    print(state);
}

void Progress::setTitle(std::string_view title) {
    mTitle = printable(title);
    if (mQuiet || !mTerminal || mLineOpen) return; // a bar shows the title when it is next drawn
    fmt::print(stderr, "\r{}\033[K", mTitle);
    std::fflush(stderr);
    mTitleOpen = true;
}

void Progress::print(const State& state) {
    const std::string left = state.done == 0 || state.done >= mTotal
                                 ? ""
                                 : fmt::format(", {} left", durationText(state.secondsLeft));
    const std::string text = fmt::format("{} {:3.0f} %  {}/{} {}, {:.0f}/s{}", mTitle, 100 * state.fraction,
                                         state.done, mTotal, mUnit, state.perSecond, left);
    if (!mTerminal) {
        fmt::print(stderr, "{}\n", text);
        return;
    }
    constexpr int kWidth = 24;
    const int filled = int(state.fraction * kWidth);
    fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(size_t(filled), '='),
               std::string(size_t(kWidth - filled), ' '), text);
    mTitleOpen = false;
    mLineOpen = true;
    if (state.done >= mTotal) {
        fmt::print(stderr, "\n");
        mLineOpen = false;
    }
}

} // namespace relume
