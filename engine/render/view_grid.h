// The view directions that lit spheres are made for: corners of cells of equal angle, kGridCells a side on
// each face of a cube. A view is mixed of the four corners of its cell. GLSL twin:
// shaders/lib/view_grid.glsl.
#pragma once

#include "engine/math/vector.h"
#include "shaders/shared/sphere.h"

#include <array>
#include <set>

namespace relume {

// The unit direction of a node, (face · kGridSide + y) · kGridSide + x, from 0 to kGridNodes - 1.
vec3 gridDirection(uint32_t node);

struct GridCell {
    std::array<uint32_t, 4> nodes; // left to right, top to bottom
    vec2 place;                    // in the cell, 0 to 1
};
GridCell gridCell(vec3 direction);

// Adds the nodes of all cells that directions from -(corner + x right + y down) meet, x and y in the
// rectangle (left, top) to (right, bottom).
void addGridNodes(std::set<uint32_t>& nodes, vec3 corner, vec3 right, vec3 down, vec2 leftTop,
                  vec2 rightBottom);

} // namespace relume
