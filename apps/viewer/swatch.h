// Renders small images of materials.
#pragma once

#include "engine/image/image.h"

#include <string>

namespace relume {

// Returns an image of a ball of a material (AssetMaterial::description) under the built-in sky, with the
// exact BRDF but without shadows; linear, alpha is coverage. Takes about a tenth of a second. Throws Error if
// measured data is missing.
Image renderSwatch(const std::string& description, int size);

} // namespace relume
