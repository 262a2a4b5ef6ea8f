// Where the time of a sequence of frames went: spans of CPU and GPU work on one clock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace relume {

struct TimingSpan {
    enum class Track { Cpu, Gpu };

    Track track;
    std::optional<uint32_t> frame; // counted from 0; none outside frames
    std::string name;
    int64_t start;    // nanoseconds since the capture began
    int64_t duration; // nanoseconds
};

// How the device's clock was related to the CPU's.
enum class ClockMatch {
    None,       // no relation is known: there are no GPU spans
    Calibrated, // both clocks were read together (VK_EXT_calibrated_timestamps)
    Anchored,   // the device wrote a timestamp between two readings of the CPU's clock
};

struct TimingTrace {
    std::string device, driver;
    ClockMatch clock = ClockMatch::None;
    int64_t clockUncertainty = 0; // error of GPU spans against CPU spans, in nanoseconds, either way
    // Ordered by track, then start; of spans that start together the longest comes first, so that a span
    // precedes those inside it. Spans of a track nest or are disjoint.
    std::vector<TimingSpan> spans;
};

} // namespace relume
