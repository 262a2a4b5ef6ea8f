// What a run of frames spent its time on: spans of CPU and GPU on one clock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace relume {

struct TimingSpan {
    enum class Track { Cpu, Gpu };

    Track track;
    std::optional<uint32_t> frame; // from 0; none outside the frames
    std::string name;
    int64_t start;    // nanoseconds since the capture began
    int64_t duration; // nanoseconds
};

// How the device's clock was put on the CPU's.
enum class ClockMatch {
    None,       // not at all: there are no GPU spans
    Calibrated, // both read together, VK_EXT_calibrated_timestamps
    Anchored,   // by a timestamp that the device wrote between two readings of the CPU's clock
};

struct TimingTrace {
    std::string device, driver;
    ClockMatch clock = ClockMatch::None;
    int64_t clockUncertainty = 0; // nanoseconds that GPU spans may be off against CPU spans
    // By track, then start; of two that start together the longer comes first, so that a span precedes those
    // inside it. Spans of a track nest or are disjoint.
    std::vector<TimingSpan> spans;
};

} // namespace relume
