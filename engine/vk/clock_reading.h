// Simultaneous readings of the device's and the CPU's clock.
#pragma once

#include <cstdint>

namespace relume::vk {

class Device;

struct ClockReading {
    uint64_t ticks;      // the device's timestamp
    int64_t cpu;         // cpuNanoseconds() at that moment
    int64_t uncertainty; // nanoseconds that the pair may be off, either way
};

// Returns CLOCK_MONOTONIC, a clock that devices can read together with their own.
int64_t cpuNanoseconds();

// Reads both clocks together. Requires Device::readClocks() to be non-null.
ClockReading readCalibrated(const Device& device);

// Lets the device write a timestamp between two readings of the CPU's clock. Submits and waits. Requires
// Device::timestampBits() > 0.
ClockReading readAnchored(const Device& device);

} // namespace relume::vk
