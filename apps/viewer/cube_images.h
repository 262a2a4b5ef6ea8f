// Unfolds cubes of texels, such as lights, into flat images.
#pragma once

#include "engine/image/image.h"
#include "engine/light/light_cube.h"

namespace relume {

// Returns a latlong map of `width` by width / 2, oriented as environments: one texel per pixel, alpha 1.
Image latlongOf(const LightCube& cube, int width);

// Returns a cross of 4 by 3 faces seen from inside: +X, +Z, -X, -Z from left to right as in a latlong map, +Y
// above +Z and -Y below. Texels are `scale` pixels wide; alpha is 0 outside.
Image crossOf(const LightCube& cube, int scale = 1);

// The azimuth and elevation, as of directionAt(), of a place on a latlong map; places are in [0, 1] from the
// upper left.
struct MapAngles {
    float azimuth, elevation; // degrees
};
MapAngles anglesAt(vec2 place);

// Returns a map of this size, averaged over whole pixels of the environment.
Image thumbnailOf(const Environment& map, int width, int height);

} // namespace relume
