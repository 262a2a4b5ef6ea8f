// The grid of view directions for which lit spheres are made: corners of cells of equal angle, kGridCells a
// side on each face of a cube. A view interpolates the four corners of its cell. GLSL twin:
// shaders/lib/view_grid.glsl.
#pragma once

#include "engine/math/vector.h"
#include "shaders/shared/sphere.h"

#include <array>
#include <set>

namespace relume {

// Returns the unit direction of a node: (face · kGridSide + y) · kGridSide + x, from 0 to kGridNodes - 1.
vec3 gridDirection(uint32_t node);

struct GridCell {
    std::array<uint32_t, 4> nodes; // left to right, top to bottom
    vec2 place;                    // within the cell, 0 to 1
};
// Returns the cell of a direction.
GridCell gridCell(vec3 direction);

// Adds the nodes of all cells that are met by directions -(corner + x · right + y · down), with (x, y) in the
// rectangle from leftTop to rightBottom.
void addGridNodes(std::set<uint32_t>& nodes, vec3 corner, vec3 right, vec3 down, vec2 leftTop,
                  vec2 rightBottom);

} // namespace relume
