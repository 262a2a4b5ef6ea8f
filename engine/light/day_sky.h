// The day sky: sun, sky and ground under a clear or hazy atmosphere.
#pragma once

#include "engine/light/lamp.h"
#include "shaders/shared/light.h"

namespace relume {

// Radiance 1 stands for 100,000 lx / π: white in full sunlight.
struct DaySky {
    vec3 sun;               // direction, unit length; may be below the horizon
    float turbidity = 2.5f; // 2 (clear) to 10 (hazy)
    vec3 ground{0.2f};      // what share of light it gives back, in [0, 1]: all below the horizon
    bool hasDisc = true;    // the sun itself; without it, only the light it scatters
    float gain = 1;

    bool operator==(const DaySky&) const = default;
};

// The sky's luminance and chromaticity by Preetham, Shirley, Smits: A Practical Analytic Model for Daylight,
// 1999. Below the horizon the sun's sky keeps the shape that it had at sunset and darkens tenfold every 2.9
// degrees (400 lx at sunset, 3.4 lx at the end of civil twilight, 6 degrees below). Colors out of gamut are
// clamped. The ground is of one radiance: `ground` times the horizontal irradiance of sky and sun over π.
shared::LightSky makeSkyModel(const DaySky& sky);

// Radiance towards a unit direction, without the sun's disc. GLSL twin: shaders/lib/sky.glsl.
vec3 skyRadiance(const shared::LightSky& model, vec3 direction);

// The sun's disc, 0.53 degrees across, as dim as the air makes it (the transmittances of the same paper, at
// 610, 550 and 465 nm), and as its part above the horizon; a radiance of zero without a disc.
Lamp sunLamp(const DaySky& sky);

// Adds the mean of 2 × 2 sub-cells to each texel: the sky, without the sun. CPU twin of
// shaders/light_sky.comp.
void addSky(LightCube& cube, const DaySky& sky);

} // namespace relume
