// Chooses vertices of a mesh that represent all of them.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// A vertex is represented only by vertices whose normals have a cosine above this with its own.
constexpr float kLeastNormalCosine = 0.25f;

// Returns the side of the square that each of `count` vertices would have of the mesh's surface; > 0.
float vertexSpacing(const Mesh& mesh, size_t count);

// The weight of a normal's rotation in distances, in spacings per radian.
constexpr float kNormalWeight = 5;

// Returns at least `count` (1 to all) vertices in ascending order, distributed as the mesh's vertices are:
// the middles of `count` groups of equal size, near in position and normal, and a few more, so that every
// vertex has one with a similar normal (kLeastNormalCosine). `spacing` is vertexSpacing(mesh, count).
std::vector<uint32_t> coarseVertices(const Mesh& mesh, size_t count, float spacing);

} // namespace relume
