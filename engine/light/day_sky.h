// The day sky: sun, sky and ground under a clear or hazy atmosphere.
#pragma once

#include "engine/light/lamp.h"
#include "shaders/shared/light.h"

namespace relume {

// A day sky. Radiance 1 stands for a luminance of 100,000 / π cd/m²: that of white in full sunlight.
struct DaySky {
    vec3 sun;               // direction, unit length; may be below the horizon
    float turbidity = 2.5f; // 2 (clear) to 10 (hazy)
    vec3 ground{0.2f};      // albedo in [0, 1] of the ground, which is all below the horizon
    bool hasDisc = true;    // whether the sun itself is there; without it, only the light it scatters
    float gain = 1;

    bool operator==(const DaySky&) const = default;
};

// Returns the sky's luminance and chromaticity by Preetham, Shirley, Smits: A Practical Analytic Model for
// Daylight, 1999. With the sun below the horizon the sky keeps the shape that it had at sunset and darkens
// tenfold every 2.9 degrees (400 lx at sunset, 3.4 lx at the end of civil twilight, 6 degrees below). Colors
// out of gamut are clamped. The ground has a uniform radiance: `ground` times the horizontal irradiance of
// sky and sun over π.
shared::LightSky makeSkyModel(const DaySky& sky);

// Returns the radiance from a unit direction, without the sun's disc. GLSL twin: shaders/lib/sky.glsl.
vec3 skyRadiance(const shared::LightSky& model, vec3 direction);

// Returns the sun's disc, 0.53 degrees across, dimmed by the air (the transmittances of the same paper, at
// 610, 550 and 465 nm) and by the share of it that is below the horizon. Its radiance is zero without a disc.
Lamp sunLamp(const DaySky& sky);

// Adds the sky, without the sun, to each texel: the mean of 2 × 2 sub-cells. CPU twin of
// shaders/light_sky.comp.
void addSky(LightCube& cube, const DaySky& sky);

} // namespace relume
