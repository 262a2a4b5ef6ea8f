#include "engine/vk/tick_clock.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>

namespace relume::vk {

uint64_t ticksBetween(uint64_t start, uint64_t end, uint32_t validBits) {
    RELUME_CHECK(validBits >= 1 && validBits <= 64);
    return (end - start) & (~uint64_t(0) >> (64 - validBits));
}

TickClock::TickClock(double nanosecondsPerTick, uint32_t validBits)
    : mNanosecondsPerTick(nanosecondsPerTick), mValidBits(validBits) {
    RELUME_CHECK_LT(0, nanosecondsPerTick);
    RELUME_CHECK(validBits >= 1 && validBits <= 64);
}

void TickClock::calibrate(uint64_t ticks, int64_t cpu) {
    if (mCalibrations.empty()) {
        mFirst = ticks;
        mCalibrations.push_back({0, cpu});
        return;
    }
    const Calibration next{sinceFirst(ticks, cpu), cpu}, &last = mCalibrations.back();
    // Calibrations within one tick of a coarse counter define no line.
    if (next.ticks > last.ticks && next.cpu >= last.cpu) mCalibrations.push_back(next);
}

int64_t TickClock::sinceFirst(uint64_t ticks, int64_t near) const {
    RELUME_CHECK(!mCalibrations.empty());
    const auto expected = std::llround(double(near - mCalibrations[0].cpu) / mNanosecondsPerTick);
    // Difference between the reading and the expected value, as a signed number of validBits bits.
    const uint64_t difference = ticks - mFirst - uint64_t(expected);
    const uint32_t unused = 64 - mValidBits;
    return int64_t(uint64_t(expected) + uint64_t(int64_t(difference << unused) >> unused));
}

int64_t TickClock::nanoseconds(int64_t ticks) const {
    RELUME_CHECK(!mCalibrations.empty());
    const auto after = std::upper_bound(mCalibrations.begin(), mCalibrations.end(), ticks,
                                        [](int64_t value, const Calibration& c) { return value < c.ticks; });
    const Calibration& from = after == mCalibrations.begin() ? *after : *std::prev(after);
    double rate = mNanosecondsPerTick;
    if (after != mCalibrations.begin() && after != mCalibrations.end())
        rate = double(after->cpu - from.cpu) / double(after->ticks - from.ticks);
    return from.cpu + std::llround(double(ticks - from.ticks) * rate);
}

} // namespace relume::vk
