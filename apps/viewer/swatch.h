// What a material looks like, in small.
#pragma once

#include "engine/image/image.h"

#include <string>

namespace relume {

// A ball of a material (AssetMaterial::description) under the built-in sky and without shadows, linear, with
// its exact BRDF; alpha is coverage. Takes about a tenth of a second. Throws Error for measured data that is
// gone.
Image renderSwatch(const std::string& description, int size);

} // namespace relume
