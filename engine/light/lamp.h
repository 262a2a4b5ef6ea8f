// Lamps: distant spheres of constant radiance.
#pragma once

#include "engine/light/light_cube.h"
#include "shaders/shared/light.h"

namespace relume {

struct Lamp {
    vec3 direction;      // any length but zero
    float angularRadius; // radians, in (0, π]
    vec3 radiance;
};

// Returns the lamp as the device takes it; its amount is its solid angle.
shared::LightCap makeLampCap(const Lamp& lamp, int size);

// Adds a lamp to the cube: its radiance times the share of each texel that it covers, scaled so that Σ
// radiance · solid angle is exact. CPU twin of shaders/light_lamp_gains.comp and light_lamps.comp.
void addLamp(LightCube& cube, const Lamp& lamp);

} // namespace relume
