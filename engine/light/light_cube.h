// The light as 6 × size² texels of mean radiance: the only form in which light reaches relighting.
#pragma once

#include "engine/light/environment.h"

namespace relume {

struct LightCube {
    int size = 0;               // texels a side
    std::vector<vec3> radiance; // 6 · size², face by face, row by row; mean over the texel
};

// Samples a prepared environment, turned by `rotation` radians about +Y (a positive angle turns what was
// seen along +Z towards +X). A texel is the mean of n × n bilinear lookups, n = samplesPerTexelSide, at the
// centres of its sub-cells in (u, v), weighted by (1 + u² + v²)^(-3/2). A single bright pixel keeps its
// irradiance within 2 %, wherever it is. CPU twin of shaders/light_sample.comp.
LightCube sampleEnvironment(const Environment& prepared, int size, float rotation);

// Subdivisions a side of a cube texel when sampling: a fifth of a pixel of the map at the equator, at least
// 2. (A pixel's bilinear tent sampled at distance 1/f pixels errs by up to 2 sinc²(f) along each axis: 3 %
// for half a pixel, 0.7 % for a fifth.)
int samplesPerTexelSide(int environmentWidth, int cubeSize);

// Light from one direction: the texel that holds it carries `irradiance` (on a surface that faces it).
LightCube makeDistantLight(vec3 direction, vec3 irradiance, int size);

// A distant sphere of constant radiance seen under `angularRadius`, in (0, π] radians; covers texels by
// fraction, scaled so that Σ radiance · solid angle is exact.
LightCube makeSphereLight(vec3 direction, float angularRadius, vec3 radiance, int size);

} // namespace relume
