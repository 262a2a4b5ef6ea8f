#include "precompute/refine/edge_split.h"

#include "engine/base/check.h"

#include <algorithm>
#include <array>
#include <optional>

namespace relume {

namespace {

float squaredLength(vec3 v) { return glm::dot(v, v); }

// Cuts a triangle whose first corner's two edges are split at `ab` and `ca`. The remaining quadrilateral is
// cut along its shorter diagonal.
void splitTwo(const Mesh& mesh, uvec3 corners, uint32_t ab, uint32_t ca, std::vector<uvec3>& triangles) {
    const auto [a, b, c] = std::array{corners.x, corners.y, corners.z};
    triangles.push_back({a, ab, ca});
    const std::vector<vec3>& at = mesh.positions;
    if (squaredLength(at[ab] - at[c]) <= squaredLength(at[ca] - at[b])) {
        triangles.push_back({ab, b, c});
        triangles.push_back({ab, c, ca});
    } else {
        triangles.push_back({ab, b, ca});
        triangles.push_back({b, c, ca});
    }
}

// Splits a triangle. `middles` are those of the edges from x to y, y to z and z to x; none where an edge
// stays whole.
void split(const Mesh& mesh, uvec3 triangle, std::array<std::optional<uint32_t>, 3> middles,
           std::vector<uvec3>& triangles) {
    const auto count = std::ranges::count_if(middles, [](const auto& middle) { return middle.has_value(); });
    if (count == 0) {
        triangles.push_back(triangle);
        return;
    }
    if (count == 3) {
        const uint32_t xy = *middles[0], yz = *middles[1], zx = *middles[2];
        triangles.insert(triangles.end(),
                         {{triangle.x, xy, zx}, {xy, triangle.y, yz}, {zx, yz, triangle.z}, {xy, yz, zx}});
        return;
    }
    // Rotate until the first edge is split; of two split edges, the last must be the other.
    while (!middles[0] || (count == 2 && !middles[2])) {
        triangle = {triangle.y, triangle.z, triangle.x};
        middles = {middles[1], middles[2], middles[0]};
    }
    if (count == 2) {
        splitTwo(mesh, triangle, *middles[0], *middles[2], triangles);
    } else {
        triangles.push_back({triangle.x, *middles[0], triangle.z});
        triangles.push_back({*middles[0], triangle.y, triangle.z});
    }
}

} // namespace

EdgeMiddle middleOf(const Mesh& mesh, Edge edge) {
    const vec3 sum = mesh.normals[edge.first] + mesh.normals[edge.second];
    const float length = glm::length(sum);
    constexpr float kOpposite = 1e-3f; // below this a sum of unit normals has no direction
    EdgeMiddle middle{0.5f * (mesh.positions[edge.first] + mesh.positions[edge.second]),
                      length > kOpposite ? sum / length : mesh.normals[edge.first]};
    if (!mesh.tangents.empty()) {
        // Opposite tangents also sum to no direction.
        const vec3 tangents = mesh.tangents[edge.first] + mesh.tangents[edge.second];
        const bool isAny = glm::length(glm::cross(tangents, middle.normal)) > kOpposite;
        middle.tangent = tangentFrame(middle.normal, isAny ? tangents : mesh.tangents[edge.first]).s;
    }
    return middle;
}

void splitEdges(Mesh& mesh, std::span<const Edge> edges) {
    RELUME_CHECK_EQ(mesh.normals.size(), mesh.vertexCount());
    const auto firstNew = uint32_t(mesh.vertexCount());
    std::vector<std::pair<Edge, uint32_t>> sorted;
    for (const Edge& edge : edges) {
        sorted.emplace_back(edge, uint32_t(mesh.vertexCount()));
        const EdgeMiddle middle = middleOf(mesh, edge);
        mesh.positions.push_back(middle.position);
        mesh.normals.push_back(middle.normal);
        if (!mesh.tangents.empty()) mesh.tangents.push_back(middle.tangent);
        if (!mesh.uvs.empty()) mesh.uvs.push_back(0.5f * (mesh.uvs[edge.first] + mesh.uvs[edge.second]));
        if (!mesh.colors.empty())
            mesh.colors.push_back(0.5f * (mesh.colors[edge.first] + mesh.colors[edge.second]));
    }
    RELUME_CHECK_EQ(mesh.vertexCount(), firstNew + edges.size());
    std::ranges::sort(sorted);
    const auto middle = [&](uint32_t a, uint32_t b) -> std::optional<uint32_t> {
        const auto found = std::ranges::lower_bound(sorted, std::pair(Edge(a, b), 0u));
        if (found == sorted.end() || found->first != Edge(a, b)) return std::nullopt;
        return found->second;
    };
    std::vector<uvec3> triangles;
    triangles.reserve(mesh.triangleCount() + 2 * edges.size());
    for (const uvec3& t : mesh.triangles)
        split(mesh, t, {middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x)}, triangles);
    mesh.triangles = std::move(triangles);
}

} // namespace relume
