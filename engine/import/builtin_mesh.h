// Meshes generated in code: for tests, and for `relume bake` with no file. With uvs, an image covers each
// once; vertices are doubled along the seams.
#pragma once

#include "engine/scene/mesh.h"

#include <string_view>

namespace relume {

// A unit sphere about the origin from a subdivided icosahedron: 10·4^levels + 2 vertices. The image is a
// latlong whose center faces +Z.
Mesh makeSphere(int levels, bool hasUvs = false);

// A torus about the Y axis, `around` × `across` vertices.
Mesh makeTorus(float majorRadius, float minorRadius, int around, int across, bool hasUvs = false);

// The default object: a (2, 3) torus knot, smooth, self-shadowing; about `vertices` vertices.
Mesh makeKnot(int vertices = 12000, bool hasUvs = false);

// A square in the plane y = 0, side `size`, `quads` a side, normals up. The image's right is
// +X, its lower edge faces +Z.
Mesh makePlane(float size, int quads, bool hasUvs = false);

} // namespace relume
