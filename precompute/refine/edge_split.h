// Splits edges at their midpoints without leaving cracks.
#pragma once

#include "engine/scene/mesh.h"

#include <compare>
#include <span>

namespace relume {

// Two vertices of a mesh, smaller index first.
struct Edge {
    uint32_t first, second;

    Edge(uint32_t a, uint32_t b) : first(std::min(a, b)), second(std::max(a, b)) {}
    auto operator<=>(const Edge&) const = default;
};

// Splits each of `edges`, distinct edges of a mesh with normals, by a new vertex vertexCount() + i at its
// midpoint: position, uv and color are means of the ends', normal and tangent their normalized sums.
// Triangles with one, two or three of the edges become two, three or four, so that neighbors stay joined and
// the surface is unchanged.
void splitEdges(Mesh& mesh, std::span<const Edge> edges);

// The vertex that splitEdges() would add.
struct EdgeMiddle {
    vec3 position, normal;
    vec3 tangent{0}; // 0 if the mesh has none

    TangentFrame frame() const { return tangentFrame(normal, tangent); }
};
EdgeMiddle middleOf(const Mesh& mesh, Edge edge);

} // namespace relume
