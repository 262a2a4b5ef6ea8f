// Triangles whose first vertices tell them apart.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// The triangles of a mesh, their corners turned so that triangle t begins with vertex t: a draw that keeps
// the first vertex's number knows which triangle it draws, on devices without primitive numbers and at no
// cost on those that count slowly. Vertices are copies of the mesh's; after those that begin a triangle come
// the others that are needed. Of several copies a triangle has the one that a triangle shortly before it had.
struct NumberedTriangles {
    std::vector<vec3> positions; // at least one per triangle
    std::vector<uvec3> triangles;
};
NumberedTriangles numberTriangles(const Mesh& mesh);

} // namespace relume
