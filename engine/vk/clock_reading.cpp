#include "engine/vk/clock_reading.h"

#include "engine/vk/commands.h"
#include "engine/vk/result.h"

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
