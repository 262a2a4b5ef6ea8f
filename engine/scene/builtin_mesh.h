// Meshes generated in code: for tests, and for `relume bake` with no file.
#pragma once

#include "engine/scene/mesh.h"

#include <string_view>

namespace relume {

// A unit sphere about the origin from a subdivided icosahedron: 10·4^levels + 2 vertices.
Mesh makeSphere(int levels);

// A torus about the Y axis, `around` × `across` vertices.
Mesh makeTorus(float majorRadius, float minorRadius, int around, int across);

// The default object: a (2, 3) torus knot, smooth, self-shadowing; about `vertices` vertices.
Mesh makeKnot(int vertices = 12000);

// A square in the plane y = 0, side `size`, `quads` a side, normals up.
Mesh makePlane(float size, int quads);

} // namespace relume
