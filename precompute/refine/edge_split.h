// Splitting edges in the middle without leaving cracks.
#pragma once

#include "engine/scene/mesh.h"

#include <compare>
#include <span>

namespace relume {

// Two vertices of a mesh, the smaller index first.
struct Edge {
    uint32_t first, second;

    Edge(uint32_t a, uint32_t b) : first(std::min(a, b)), second(std::max(a, b)) {}
    auto operator<=>(const Edge&) const = default;
};

// Adds a vertex in the middle of edges[i], as vertex vertexCount() + i: position, uv and color are the mean
// of the ends', normal and tangent are their normalized sums. Triangles with one, two or three of `edges`
// become two, three or four, so that all stay joined and the surface is what it was. `edges` are distinct
// edges of the mesh, which has normals.
void splitEdges(Mesh& mesh, std::span<const Edge> edges);

// The vertex that splitEdges() adds: what a bake would see there.
struct EdgeMiddle {
    vec3 position, normal;
    vec3 tangent{0}; // 0 if the mesh has none

    TangentFrame frame() const { return tangentFrame(normal, tangent); }
};
EdgeMiddle middleOf(const Mesh& mesh, Edge edge);

} // namespace relume
