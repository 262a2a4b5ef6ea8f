// Distant lights: light from single directions.
#pragma once

#include "engine/light/light_cube.h"
#include "shaders/shared/light.h"

#include <span>

namespace relume {

struct DistantLight {
    vec3 direction;  // any length but zero
    vec3 irradiance; // on a surface that faces it
};

// What the lights add to texels of a cube of `size` ≥ 2 texels a side, by rising index, none twice. A light's
// irradiance goes to the four texels around its direction in bilinear shares, across the cube's edges too; at
// a corner, where three texels meet, the fourth share goes to these in thirds. Irradiance is exact, and
// nothing jumps as a light moves.
std::vector<shared::LightTap> distantTaps(std::span<const DistantLight> lights, int size);

// CPU twin of shaders/light_distant.comp.
void addDistantLights(LightCube& cube, std::span<const DistantLight> lights);

} // namespace relume
