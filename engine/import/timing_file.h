// Writing of timings to files: trace events and tables.
#pragma once

#include "engine/base/timing_trace.h"

#include <filesystem>

namespace relume {

// Returns "none", "calibrated" or "anchored".
const char* nameOf(ClockMatch clock);

// Returns trace events that Perfetto and chrome://tracing open: complete events on two threads, CPU and GPU,
// with times in microseconds; device, driver and clock are in "otherData".
std::string chromeTrace(const TimingTrace& trace);

// Returns a CSV table: frame (empty outside frames), track, name, start_us, duration_us.
std::string csvTable(const TimingTrace& trace);

// Throws UsageError unless `path` ends in .json or .csv, Error if it cannot be written. Use before long work.
void expectTimingFile(const std::filesystem::path& path);

// Writes chromeTrace() to a .json file or csvTable() to a .csv file, atomically. Throws Error.
void writeTimings(const std::filesystem::path& path, const TimingTrace& trace);

} // namespace relume
