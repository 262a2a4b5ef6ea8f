// Meshes generated in code, for tests and for `relume bake` without a file. With uvs an image covers each
// once, and vertices are doubled along the seams.
#pragma once

#include "engine/scene/mesh.h"

#include <string_view>

namespace relume {

// Returns a unit sphere about the origin from a subdivided icosahedron: 10·4^levels + 2 vertices. The image
// is a latlong map whose center faces +Z.
Mesh makeSphere(int levels, bool hasUvs = false);

// Returns a torus about the Y axis, of `around` × `across` vertices.
Mesh makeTorus(float majorRadius, float minorRadius, int around, int across, bool hasUvs = false);

// Returns the default object, a smooth, self-shadowing (2, 3) torus knot of about `vertices` vertices.
Mesh makeKnot(int vertices = 12000, bool hasUvs = false);

// Returns a square in the plane y = 0 with sides of `size` and `quads` quads along each, normals up. The
// image's right is +X; its lower edge faces +Z.
Mesh makePlane(float size, int quads, bool hasUvs = false);

// The diffuse ground under an object: a tessellated square at the object's lowest point.
struct GroundOptions {
    int tessellation = 148;   // quads a side: 149² = 22,201 vertices, the paper's ground for the bunny
    float extent = 3.0f;      // side, in multiples of the object's largest extent along an axis
    bool isRefinable = false; // whether refinement may add vertices: the tessellation was not asked for
};

// Quads a side of a ground that will be refined, by default.
constexpr int kRefinedGroundQuads = 16;

// Limits of addGround() and scene files.
constexpr int kMostGroundQuads = 4096;
constexpr float kSmallestGroundExtent = 0.01f, kLargestGroundExtent = 1000.0f;

// Returns a square centered under `object` in x and z, at its lowest y, normals up.
Mesh makeGround(const Bounds& object, const GroundOptions& options = {});

} // namespace relume
