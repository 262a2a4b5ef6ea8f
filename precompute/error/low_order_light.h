// Light as low-order spherical harmonics leave it.
#pragma once

#include "engine/light/light_cube.h"

namespace relume {

// The light's projection on the order² real spherical harmonics of degrees below `order`, 1 to 16: what is
// left of it where transport is kept in as many coefficients, as transport is projected too (Sloan, Kautz and
// Snyder, "Precomputed Radiance Transfer", 2002). Can be negative. Not windowed.
LightCube lowOrderLight(const LightCube& light, int order);

} // namespace relume
