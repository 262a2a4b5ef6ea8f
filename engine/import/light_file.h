// Light as files describe it: docs/light_format.md.
#pragma once

#include "engine/import/moving_light.h"

namespace relume {

constexpr float kSmallestLampRadius = 1e-4f; // degrees

// Throws Error that names file and field.
MovingLight readLight(const std::filesystem::path& path);

} // namespace relume
