// The grid of view directions for which lit spheres are made. C++ twin: engine/render/view_grid.h.
#ifndef RELUME_LIB_VIEW_GRID_GLSL
#define RELUME_LIB_VIEW_GRID_GLSL
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/sphere.h"

struct GridCell {
    uint first; // its upper left node
    vec2 place; // within the cell, 0 to 1
};

GridCell gridCell(vec3 direction) {
    const uint face = cubeFace(direction);
    const float kQuarter = 1.5707963267949;
    const vec2 place =
        clamp((atan(cubeCoordinates(face, direction)) / kQuarter + 0.5) * float(kGridCells), 0, float(kGridCells));
    const uvec2 low = min(uvec2(place), uvec2(kGridCells - 1));
    return GridCell((face * kGridSide + low.y) * kGridSide + low.x, place - vec2(low));
}

#endif
