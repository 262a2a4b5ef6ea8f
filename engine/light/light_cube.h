// The light as 6 × size² texels of mean radiance: the only form in which light reaches relighting.
#pragma once

#include "engine/light/environment.h"

namespace relume {

struct LightCube {
    int size = 0;               // texels a side
    std::vector<vec3> radiance; // 6 · size², face by face, row by row; mean over the texel
};

// Samples a prepared environment, turned by `rotation` radians about +Y (a positive angle turns what was
// seen along +Z towards +X). CPU twin of shaders/light_sample.comp.
LightCube sampleEnvironment(const Environment& prepared, int size, float rotation);

// Subdivisions a side of a cube texel when sampling: half a pixel of the map at the equator, at least 2.
int samplesPerTexelSide(int environmentWidth, int cubeSize);

// Light from one direction: the texel that holds it carries `irradiance` (on a surface that faces it).
LightCube makeDistantLight(vec3 direction, vec3 irradiance, int size);

// A distant sphere of constant radiance seen under `angularRadius` radians; covers texels by fraction.
LightCube makeSphereLight(vec3 direction, float angularRadius, vec3 radiance, int size);

} // namespace relume
