// Cubes of texels, such as lights, laid out flat.
#pragma once

#include "engine/image/image.h"
#include "engine/light/light_cube.h"

namespace relume {

// A latlong map of `width` by width / 2, as environments are: one texel a pixel, alpha 1.
Image latlongOf(const LightCube& cube, int width);

// A cross of 4 by 3 faces, seen from within: +X, +Z, -X, -Z from left to right, as a latlong shows them, +Y
// above +Z and -Y below. Each texel is `scale` pixels a side; alpha 0 outside.
Image crossOf(const LightCube& cube, int scale = 1);

// A place on a latlong map, in [0, 1] from the upper left, as directionAt()'s azimuth and elevation.
struct MapAngles {
    float azimuth, elevation; // degrees
};
MapAngles anglesAt(vec2 place);

// A map of this size, averaged over whole pixels of the environment's.
Image thumbnailOf(const Environment& map, int width, int height);

} // namespace relume
