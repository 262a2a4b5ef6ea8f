// Triangles that are identified by their first vertices.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// The triangles of a mesh, with corners rotated so that triangle t begins with vertex t. A draw that passes
// on the first vertex's number then knows which triangle it draws, on devices without primitive numbers and
// at no cost on those that count slowly. Vertices are copies of the mesh's: those that begin a triangle,
// followed by the others that are needed. Of several copies a triangle uses one used recently.
struct NumberedTriangles {
    std::vector<vec3> positions; // at least one per triangle
    std::vector<uvec3> triangles;
};
NumberedTriangles numberTriangles(const Mesh& mesh);

} // namespace relume
