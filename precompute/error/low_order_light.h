// Projects light onto low-order spherical harmonics.
#pragma once

#include "engine/light/light_cube.h"

namespace relume {

// Returns the light's projection onto the order² real spherical harmonics of degree below `order`, 1 to 16,
// without windowing. Results can be negative. This is the light that transport projected onto as many
// coefficients can represent (Sloan, Kautz and Snyder, "Precomputed Radiance Transfer", 2002).
LightCube lowOrderLight(const LightCube& light, int order);

} // namespace relume
