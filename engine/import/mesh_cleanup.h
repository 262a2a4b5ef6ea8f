// From triangles as a file gives them to a mesh that every stage can trust.
#pragma once

#include "engine/scene/mesh.h"

#include <string>

namespace relume {

// More than any mesh that could be baked; a bound on what small files of many instances can unfold to.
constexpr size_t kMostMeshVertices = size_t(1) << 28, kMostMeshTriangles = size_t(1) << 28;

// Takes unchecked positions, triangles, normals of any length, uvs and colors. Checks indices and finiteness;
// welds vertices that are equal in position and every attribute that is there; drops degenerate triangles and
// unreferenced vertices, in that order and with a count in the log; keeps the order of what stays. Normals
// become unit length; where one is missing or has no length all are made anew, weighted by angle. Uvs and
// colors that not every vertex has are dropped; colors are clamped to [0, 1].
// Throws Error, in which `name` stands for the file, for indices out of range, values that are not finite,
// sizes out of range (beyond 1e9 units, or less than 1e-9 across), and when no triangle is left.
Mesh cleanUp(Mesh mesh, const std::string& name);

} // namespace relume
