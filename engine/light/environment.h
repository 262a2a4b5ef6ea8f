// Distant environments as latitude-longitude maps.
#pragma once

#include "engine/image/image.h"

#include <memory>

namespace relume {

// The four pixels around a point of a map, and the bilinear weights towards x1 and y1.
struct MapTaps {
    int x0, y0, x1, y1;
    vec2 weight;
};

// A latlong map with pixel centers. Column x has longitude π - 2π (x + ½) / width, row y latitude π/2 - π (y
// + ½) / height; the direction is (sin lon cos lat, sin lat, cos lon cos lat). +Y is up, the center looks
// along +Z, and a quarter turn left of it along +X, as OpenEXR defines its latlong.
struct Environment {
    int width = 0, height = 0;
    std::vector<vec3> radiance; // W·m⁻²·sr⁻¹, rows from the top

    // Returns the direction of a point in pixel units; (0.5, 0.5) is the center of the first pixel.
    vec3 direction(float column, float row) const;
    vec2 place(vec3 direction) const;   // inverts direction()
    MapTaps taps(vec3 direction) const; // wrapping in longitude, clamped in latitude
    vec3 lookup(vec3 direction) const;  // bilinear, by taps()
};

// The most columns of a map that is kept for display: 22 per degree.
constexpr int kMostPictureColumns = 8192;

// Returns the map for display: itself, or area-averaged down to kMostPictureColumns.
std::shared_ptr<const Environment> makePicture(Environment environment);

// Columns of the built-in sky for display.
constexpr int kSkyPictureColumns = 2048;

// Generates the built-in sky: blue above, warm near the horizon, brown below, with a soft sun.
Environment makeSky(int width = 512);

// Returns the map from which light is sampled. It is area-averaged down to at most `maxWidth` columns (with
// the default the smallest texel of a cube of 64 is a pixel wide). Each row is then averaged twice over 1 /
// cos(latitude) columns, so that a pixel near a pole is as wide as one at the equator, and the three rows
// around each pole are averaged. Keeps Σ radiance · solid angle to 1e-6.
Environment prepareForSampling(const Environment& environment, int maxWidth = 512);

// Blurs a map by diffusion on the sphere until a point has a standard deviation of `deviation` radians along
// each axis: a Gaussian if that is small. Keeps Σ radiance · solid angle and uniform maps, up to rounding.
Environment blur(const Environment& environment, float deviation);

} // namespace relume
