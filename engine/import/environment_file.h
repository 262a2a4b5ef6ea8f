// Environment maps from files.
#pragma once

#include "engine/light/environment.h"

#include <filesystem>

namespace relume {

// Far above the sun's radiance of 2e7 W·m⁻²·sr⁻¹, yet small enough that no float sum or square overflows
// later.
constexpr float kLargestRadiance = 1e12f;

// Reads .exr (latlong, or cube by its envmap attribute) or .hdr. A file without the attribute is a latlong
// with pixel centers. A latlong with it has its first and last rows on the poles, and is resampled. A cube
// becomes a latlong of four times a face's width. Negative values become 0 and those above 1e12 become that;
// the log counts both. Throws Error, also for a latlong that is not twice as wide as high.
Environment readEnvironment(const std::filesystem::path& path);

} // namespace relume
