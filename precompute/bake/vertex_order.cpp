#include "precompute/bake/vertex_order.h"

#include "engine/base/check.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace relume {
namespace {

// The low ten bits of `value` with two zeros after each.
uint32_t spread(uint32_t value) {
    value &= 0x3ff;
    value = (value | value << 16) & 0x030000ff;
    value = (value | value << 8) & 0x0300f00f;
    value = (value | value << 4) & 0x030c30c3;
    return (value | value << 2) & 0x09249249;
}

// The Morton code of a point of the unit cube, ten bits an axis.
uint32_t mortonCode(vec3 point) {
    const vec3 cell = glm::clamp(point, vec3(0), vec3(1)) * 1023.0f + 0.5f;
    return spread(uint32_t(cell.x)) | spread(uint32_t(cell.y)) << 1 | spread(uint32_t(cell.z)) << 2;
}

struct Key {
    uint32_t position, octant, normal, index;

    bool operator<(const Key& other) const {
        return std::tie(position, octant, normal, index) <
               std::tie(other.position, other.octant, other.normal, other.index);
    }
};

std::vector<Key> sortedKeys(const Mesh& mesh) {
    const Bounds bounds = boundsOf(mesh);
    const vec3 extent = bounds.extent();
    // One scale for all axes keeps the curve's cells cubes.
    const float largest = std::max({extent.x, extent.y, extent.z});
    const float scale = largest > 0 ? 1 / largest : 0;
    std::vector<Key> keys(mesh.vertexCount());
    for (size_t i = 0; i < keys.size(); i++) {
        keys[i] = {mortonCode((mesh.positions[i] - bounds.low) * scale), 0, 0, uint32_t(i)};
        if (mesh.normals.empty()) continue;
        const vec3 n = mesh.normals[i];
        keys[i].octant = uint32_t(n.x < 0) | uint32_t(n.y < 0) << 1 | uint32_t(n.z < 0) << 2;
        keys[i].normal = mortonCode(0.5f * n + 0.5f);
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

// The same triangle, its smallest index first.
uvec3 rotated(uvec3 t) {
    if (t.y < t.x && t.y < t.z) return {t.y, t.z, t.x};
    if (t.z < t.x && t.z < t.y) return {t.z, t.x, t.y};
    return t;
}

} // namespace

void orderVertices(Mesh& mesh) {
    RELUME_CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.vertexCount());
    const std::vector<Key> keys = sortedKeys(mesh);
    std::vector<uint32_t> order(keys.size()), renumbered(keys.size());
    for (size_t i = 0; i < keys.size(); i++) {
        order[i] = keys[i].index;
        renumbered[keys[i].index] = uint32_t(i);
    }
    reorderVertices(mesh, order);
    for (uvec3& t : mesh.triangles) t = rotated({renumbered[t.x], renumbered[t.y], renumbered[t.z]});
    std::sort(mesh.triangles.begin(), mesh.triangles.end(), [](const uvec3& a, const uvec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
}

} // namespace relume
