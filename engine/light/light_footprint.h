// The pixels of a latlong map that each texel of the lighting cube averages. They depend on sizes only, so
// that after a change of light each texel is a short weighted sum, on the CPU and on the GPU.
#pragma once

#include "engine/light/environment.h"
#include "shaders/shared/render.h"

namespace relume {

struct LightFootprints {
    int width = 0, height = 0;                  // of the map
    int size = 0;                               // of the cube
    std::vector<uint32_t> starts;               // 6 size² + 1: first pixel of each texel
    std::vector<shared::FootprintPixel> pixels; // row by row within a texel; a texel's weights sum to 1
};

// Makes the footprints. A texel is the mean of n × n bilinear lookups, n = samplesPerTexelSide(), at the
// centers of its sub-cells in (u, v), weighted by (1 + u² + v²)^(-3/2). Width and height are at most 65,536.
LightFootprints makeLightFootprints(int width, int height, int size);

// Returns the subdivisions of a cube texel's side for sampling: a fifth of the map's pixel at the equator
// each, but at least 2. (A pixel's bilinear tent sampled at distance 1/f pixels errs by up to 2 sinc²(f)
// along each axis: 3 % for half a pixel, 0.7 % for a fifth.)
int samplesPerTexelSide(int environmentWidth, int cubeSize);

// A rotation of a map in columns. In a map turned by `rotation` radians about +Y (a positive angle turns +Z
// towards +X) column x is the mix by `fraction` of columns x + whole and x + whole + 1, wrapping.
struct ColumnShift {
    uint32_t whole; // whole columns, below the width
    float fraction; // fraction of a column, in [0, 1)
};
ColumnShift columnShift(float rotation, int width);

} // namespace relume
