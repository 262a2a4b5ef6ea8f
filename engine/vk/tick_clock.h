// A device's counter on the CPU's clock: turns readings of few bits, that wrap around, into times, and
// follows what one clock gains on the other from calibration to calibration.
#pragma once

#include <cstdint>
#include <vector>

namespace relume::vk {

// Ticks from `start` to `end`, less than one turn of a counter of `validBits`; the bits above them are
// anything.
uint64_t ticksBetween(uint64_t start, uint64_t end, uint32_t validBits);

class TickClock {
  public:
    // `validBits`, 1 to 64: as many low bits of a reading count, and wrap around.
    TickClock(double nanosecondsPerTick, uint32_t validBits);

    // The counter showed `ticks` when the CPU's clock showed `cpu` nanoseconds. Calls come in order of time.
    void calibrate(uint64_t ticks, int64_t cpu);

    // Ticks from the first calibration to a reading, negative before it. `near`: nanoseconds of the CPU's
    // clock less than half a turn of the counter from the reading. Needs a calibration.
    int64_t sinceFirst(uint64_t ticks, int64_t near) const;

    // Nanoseconds of the CPU's clock at sinceFirst()'s answer: in between calibrations on the line through
    // both, before and after them at the counter's own rate. Later ticks are never earlier times.
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

} // namespace relume::vk
