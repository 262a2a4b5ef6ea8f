// Which pixels of a latlong map each texel of the lighting cube is made of. They depend on sizes only, so
// that a light change is a short weighted sum a texel, on the CPU and on the GPU.
#pragma once

#include "engine/light/environment.h"
#include "shaders/shared/render.h"

namespace relume {

struct LightFootprints {
    int width = 0, height = 0;                  // of the map
    int size = 0;                               // of the cube
    std::vector<uint32_t> starts;               // 6 size² + 1: first entry of each texel
    std::vector<shared::FootprintPixel> pixels; // row by row within a texel, whose weights sum to 1
};

// A texel is the mean of n × n bilinear lookups, n = samplesPerTexelSide, at the centers of its sub-cells
// in (u, v), weighted by (1 + u² + v²)^(-3/2). Both sides of the map are at most 65,536.
LightFootprints makeLightFootprints(int width, int height, int size);

// Subdivisions a side of a cube texel when sampling: a fifth of a pixel of the map at the equator, at least
// 2. (A pixel's bilinear tent sampled at distance 1/f pixels errs by up to 2 sinc²(f) along each axis: 3 %
// for half a pixel, 0.7 % for a fifth.)
int samplesPerTexelSide(int environmentWidth, int cubeSize);

// A map turned by `rotation` radians about +Y (a positive angle turns what was seen along +Z towards +X) has
// in column x the mix by `fraction` of the map's columns x + whole and x + whole + 1, wrapping.
struct ColumnShift {
    uint32_t whole; // below the width
    float fraction;
};
ColumnShift columnShift(float rotation, int width);

} // namespace relume
