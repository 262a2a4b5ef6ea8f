// Files that timings go to: trace events and tables.
#pragma once

#include "engine/base/timing_trace.h"

#include <filesystem>

namespace relume {

// "none", "calibrated" or "anchored".
const char* nameOf(ClockMatch clock);

// Trace events that Perfetto and chrome://tracing open: complete events on two threads, CPU and GPU, times in
// microseconds; device, driver and clock in "otherData".
std::string chromeTrace(const TimingTrace& trace);

// A table: frame (empty outside frames), track, name, start_us, duration_us.
std::string csvTable(const TimingTrace& trace);

// Throws UsageError, before long work, unless `path` ends in .json or .csv, and Error if it cannot be
// written.
void expectTimingFile(const std::filesystem::path& path);

// chromeTrace() to a .json, csvTable() to a .csv; whole or not at all. Throws Error.
void writeTimings(const std::filesystem::path& path, const TimingTrace& trace);

} // namespace relume
