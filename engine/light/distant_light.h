// Distant lights: light from single directions.
#pragma once

#include "engine/light/light_cube.h"
#include "shaders/shared/light.h"

#include <span>

namespace relume {

struct DistantLight {
    vec3 direction;  // any length but zero
    vec3 irradiance; // of a surface that faces the light
};

// Returns what the lights add to the texels of a cube of `size` ≥ 2 texels a side, by rising index, no index
// twice. A light's irradiance is shared bilinearly among the four texels around its direction, across the
// cube's edges too; at a corner, where three texels meet, the fourth share is split equally among them.
// Irradiance is exact, and nothing jumps as a light moves.
std::vector<shared::LightTap> distantTaps(std::span<const DistantLight> lights, int size);

// Adds distant lights to the cube. CPU twin of shaders/light_distant.comp.
void addDistantLights(LightCube& cube, std::span<const DistantLight> lights);

} // namespace relume
