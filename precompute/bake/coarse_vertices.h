// Which vertices of a mesh stand for all of them.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// Other vertices whose normal's cosine to one's own is at most this say nothing about it.
constexpr float kLeastNormalCosine = 0.25f;

// The side of the square that each of `count` vertices would have of the mesh's surface, > 0.
float vertexSpacing(const Mesh& mesh, size_t count);

// How much a normal's turn counts, in spacings a radian.
constexpr float kNormalWeight = 5;

// At least `count` (1 to all) vertices, rising, spread as the vertices are: the middles of `count` groups of
// equally many vertices that are near in place and normal. And a few more, so that for every vertex there
// is one whose normal is like its own. `spacing` is vertexSpacing(mesh, count).
std::vector<uint32_t> coarseVertices(const Mesh& mesh, size_t count, float spacing);

} // namespace relume
