// Light as files describe it: docs/light_format.md.
#pragma once

#include "engine/light/light.h"

#include <filesystem>

namespace relume {

// Reads a light, its environments prepared for sampling. Throws Error that names file and field.
Light readLight(const std::filesystem::path& path);

} // namespace relume
