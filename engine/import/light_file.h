// Reading of light files: docs/light_format.md.
#pragma once

#include "engine/import/moving_light.h"

namespace relume {

constexpr float kSmallestLampRadius = 1e-4f;            // degrees
constexpr float kMostRadiance = 1e9f, kMostGain = 1e6f; // of lamps and distant lights; of maps, skies

// Reads a light file. Throws Error that names file and key.
MovingLight readLight(const std::filesystem::path& path);

} // namespace relume
