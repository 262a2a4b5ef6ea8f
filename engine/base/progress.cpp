#include "engine/base/progress.h"

#include <fmt/format.h>
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

Progress::Progress(std::string title, uint64_t total, std::string unit, bool quiet)
    : mTitle(std::move(title)), mUnit(std::move(unit)), mTotal(total), mQuiet(quiet),
      mTerminal(isatty(STDERR_FILENO) != 0), mStart(Clock::now()), mLastPrint(mStart) {}

Progress::~Progress() {
    if (mLineOpen) fmt::print(stderr, "\n");
}

void Progress::update(uint64_t done) {
    if (mQuiet || mTotal == 0) return;
    const Clock::time_point now = Clock::now();
    const double seconds = secondsBetween(mStart, now);
    if (seconds < kSilentSeconds) return;
    if (mTerminal) {
        if (done < mTotal && secondsBetween(mLastPrint, now) < kRedrawSeconds) return;
    } else {
        if (done * 10 < mTotal * mNextTenth) return;
        mNextTenth = done * 10 / mTotal + 1;
    }
    mLastPrint = now;
    print(done, seconds);
}

void Progress::print(uint64_t done, double seconds) {
    const double fraction = double(done) / double(mTotal);
    const double rate = double(done) / seconds;
    const std::string left = done == 0 || done >= mTotal
                                 ? ""
                                 : fmt::format(", {} left", durationText(seconds / fraction - seconds));
    const std::string text = fmt::format("{} {:3.0f} %  {}/{} {}, {:.0f}/s{}", mTitle, 100 * fraction, done,
                                         mTotal, mUnit, rate, left);
    if (!mTerminal) {
        fmt::print(stderr, "{}\n", text);
        return;
    }
    constexpr int kWidth = 24;
    const int filled = int(fraction * kWidth);
    fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(size_t(filled), '='),
               std::string(size_t(kWidth - filled), ' '), text);
    mLineOpen = true;
    if (done >= mTotal) {
        fmt::print(stderr, "\n");
        mLineOpen = false;
    }
}

} // namespace relume
