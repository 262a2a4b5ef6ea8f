// The clocks of device and CPU, read at one moment.
#pragma once

#include <cstdint>

namespace relume::vk {

class Device;

struct ClockReading {
    uint64_t ticks;      // of the device's timestamps
    int64_t cpu;         // cpuNanoseconds() at that moment
    int64_t uncertainty; // nanoseconds it may be off either way
};

// CLOCK_MONOTONIC, which devices can be read together with.
int64_t cpuNanoseconds();

// Both read together; needs Device::readClocks().
ClockReading readCalibrated(const Device& device);

// A timestamp written between two readings of the CPU's clock. Submits and waits; needs
// Device::timestampBits().
ClockReading readAnchored(const Device& device);

} // namespace relume::vk
