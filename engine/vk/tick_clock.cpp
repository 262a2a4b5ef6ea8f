#include "engine/vk/tick_clock.h"

#include "engine/base/check.h"
#include "engine/vk/commands.h"
#include "engine/vk/result.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace relume::vk {

namespace {

// The thread may be preempted within a reading, so the narrowest of a few is used.
constexpr int kTries = 8;

template <typename Read>
ClockReading best(const Read& read) {
    ClockReading best = read();
    for (int i = 1; i < kTries; i++)
        if (const ClockReading next = read(); next.uncertainty < best.uncertainty) best = next;
    return best;
}

} // namespace

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

int64_t cpuNanoseconds() {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return int64_t(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

ClockReading readCalibrated(const Device& device) {
    VkCalibratedTimestampInfoEXT clocks[2] = {{VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT},
                                              {VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT}};
    clocks[0].timeDomain = VK_TIME_DOMAIN_DEVICE_EXT;
    clocks[1].timeDomain = VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT;
    return best([&] {
        uint64_t values[2], deviation;
        check(device.readClocks()(device.handle(), 2, clocks, values, &deviation),
              "vkGetCalibratedTimestampsEXT");
        return ClockReading{values[0], int64_t(values[1]), int64_t(deviation)};
    });
}

ClockReading readAnchored(const Device& device) {
    Commands commands(device, "clock anchor");
    return best([&] {
        commands.begin();
        commands.pass("clock anchor", [] {});
        const int64_t before = cpuNanoseconds();
        commands.submitAndWait();
        const int64_t after = cpuNanoseconds();
        return ClockReading{commands.readings()[0], before + (after - before) / 2, (after - before + 1) / 2};
    });
}

} // namespace relume::vk
