// Distant environments as latitude-longitude maps.
#pragma once

#include "engine/image/image.h"

#include <memory>

namespace relume {

// The four pixels around a place of a map: bilinear weights towards x1 and y1.
struct MapTaps {
    int x0, y0, x1, y1;
    vec2 weight;
};

// A latlong map with pixel centers: column x is longitude π - 2π (x + ½) / width, row y latitude
// π/2 - π (y + ½) / height, direction (sin lon cos lat, sin lat, cos lon cos lat): +Y up, the center
// looks along +Z, a quarter turn left of it along +X, as OpenEXR defines its latlong.
struct Environment {
    int width = 0, height = 0;
    std::vector<vec3> radiance; // W·m⁻²·sr⁻¹, rows from the top

    vec3 direction(float column,
                   float row) const;    // of a point in pixel units; (0.5, 0.5) is the first center
    vec2 place(vec3 direction) const;   // the inverse, in pixel units
    MapTaps taps(vec3 direction) const; // wrapping in longitude, clamped in latitude
    vec3 lookup(vec3 direction) const;  // bilinear, wrapping in longitude
};

// Most columns of what is kept of a map for looking at: a degree in 22 of them.
constexpr int kMostPictureColumns = 8192;

// The map as it is looked at: itself, or area-averaged down to kMostPictureColumns.
std::shared_ptr<const Environment> makePicture(Environment environment);

// Columns of the built-in sky where it is looked at.
constexpr int kSkyPictureColumns = 2048;

// The built-in sky: blue above, warm near the horizon, brown below, with a soft sun; generated in code.
Environment makeSky(int width = 512);

// The map that lights are sampled from: area-averaged down to at most `maxWidth` columns (the default gives
// a cube of 64 a pixel for its smallest texel), then each row averaged twice over 1 / cos(latitude) columns,
// so that a pixel near a pole is as wide as one at the equator, then the three rows around each pole
// averaged. Keeps Σ radiance · solid angle to 1e-6.
Environment prepareForSampling(const Environment& environment, int maxWidth = 512);

// Heat spread over the sphere until a point has a standard deviation of `deviation` radians along each axis:
// a Gaussian where that is small. Keeps Σ radiance · solid angle and even maps, to rounding.
Environment blur(const Environment& environment, float deviation);

} // namespace relume
