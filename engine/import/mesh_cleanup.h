// Cleanup of triangles from a file to a mesh that every stage can rely on.
#pragma once

#include "engine/scene/mesh.h"

#include <string>

namespace relume {

// Limits beyond any mesh that could be baked, for small files that unfold to many instances.
constexpr size_t kMostMeshVertices = size_t(1) << 28, kMostMeshTriangles = size_t(1) << 28;

// Limits of positions and of a mesh's extent, in units of the file: squares of lengths and products of four
// stay within single precision.
constexpr float kLargestCoordinate = 1e9f, kSmallestExtent = 1e-9f;

// Cleans up a mesh of unchecked positions, triangles, normals of any length, uvs and colors. Checks indices
// and finiteness; welds vertices that are equal in position and every attribute; drops degenerate triangles
// and then unreferenced vertices, counting both in the log; keeps the order of the rest. Normals become unit
// length; if one is missing or has no length, all are computed anew, weighted by angle. Uvs and colors that
// not every vertex has are dropped; colors are clamped to [0, 1].
// Throws Error if indices are out of range, values are not finite, sizes are out of range (beyond 1e9 units,
// or less than 1e-9 across), or no triangle is left; `name` names the file in it.
Mesh cleanUp(Mesh mesh, const std::string& name);

} // namespace relume
