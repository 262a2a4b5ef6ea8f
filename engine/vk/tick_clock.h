// The device's clock beside the CPU's: simultaneous readings, and conversion of the device's tick counter. It
// copes with counters of few bits that wrap around, and follows the drift between the clocks from calibration
// to calibration.
#pragma once

#include <cstdint>
#include <vector>

namespace relume::vk {

// Returns the ticks from `start` to `end`, less than one wrap of a counter of `validBits` bits. Higher bits
// are ignored.
uint64_t ticksBetween(uint64_t start, uint64_t end, uint32_t validBits);

// Converts readings of a tick counter to nanoseconds of the CPU's clock.
class TickClock {
  public:
    // `validBits`, 1 to 64, is the number of low bits of a reading that count; they wrap around.
    TickClock(double nanosecondsPerTick, uint32_t validBits);

    // Adds a calibration: the counter showed `ticks` when the CPU's clock showed `cpu` nanoseconds. Call in
    // order of time.
    void calibrate(uint64_t ticks, int64_t cpu);

    // Returns the ticks from the first calibration to a reading, negative before it. `near`, in nanoseconds
    // of the CPU's clock, must be less than half a wrap of the counter from the reading. Needs a calibration.
    int64_t sinceFirst(uint64_t ticks, int64_t near) const;

    // Converts a result of sinceFirst() to nanoseconds of the CPU's clock: linear between calibrations, at
    // the counter's nominal rate before the first and after the last. Monotonic.
    int64_t nanoseconds(int64_t ticks) const;

  private:
    struct Calibration {
        int64_t ticks; // since the first
        int64_t cpu;
    };

    double mNanosecondsPerTick;
    uint32_t mValidBits;
    uint64_t mFirst = 0; // reading at the first calibration
    std::vector<Calibration> mCalibrations;
};

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
