#include "engine/scene/mesh.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relume {
namespace {

using dvec3 = glm::dvec3;

// Returns the angle between two edges in radians; 0 if one has no length.
double cornerAngle(dvec3 a, dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

template <typename T>
void reorder(std::vector<T>& values, std::span<const uint32_t> order) {
    if (values.empty()) return;
    std::vector<T> reordered;
    reordered.reserve(order.size());
    for (const uint32_t index : order) reordered.push_back(values[index]);
    values = std::move(reordered);
}

// Appends an attribute of `otherCount` vertices to that of `count` vertices; drops it if either mesh lacks
// it.
template <typename T>
void appendAttribute(std::vector<T>& values, size_t count, const std::vector<T>& others, size_t otherCount) {
    if (values.size() == count && others.size() == otherCount)
        values.insert(values.end(), others.begin(), others.end());
    else
        values.clear();
}

} // namespace

Bounds boundsOf(const Mesh& mesh) {
    Bounds bounds;
    for (const vec3& position : mesh.positions) bounds.add(position);
    return bounds;
}

TangentFrame frameOf(const Mesh& mesh, size_t vertex) {
    const vec3 normal = mesh.normals[vertex];
    return mesh.tangents.empty() ? tangentFrame(normal) : tangentFrame(normal, mesh.tangents[vertex]);
}

void makeNormals(Mesh& mesh) {
    // In double precision, since squared areas of tiny meshes underflow in single.
    std::vector<dvec3> sums(mesh.vertexCount(), dvec3(0));
    std::vector<dvec3> fallback(mesh.vertexCount(), dvec3(0));
    for (const uvec3& triangle : mesh.triangles) {
        const dvec3 corners[3] = {mesh.positions[triangle.x], mesh.positions[triangle.y],
                                  mesh.positions[triangle.z]};
        const dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double doubleArea = glm::length(cross);
        if (!(doubleArea > 0)) continue;
        const dvec3 normal = cross / doubleArea;
        for (int i = 0; i < 3; i++) {
            const dvec3 here = corners[i], next = corners[(i + 1) % 3], last = corners[(i + 2) % 3];
            sums[triangle[i]] += normal * cornerAngle(next - here, last - here);
            if (fallback[triangle[i]] == dvec3(0)) fallback[triangle[i]] = normal;
        }
    }
    mesh.normals.resize(mesh.vertexCount());
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        // Normals of back-to-back faces cancel out; the first face then decides.
        const double length = glm::length(sums[i]);
        const dvec3 normal = length > 1e-6 ? sums[i] / length : fallback[i];
        mesh.normals[i] = normal == dvec3(0) ? vec3(0, 1, 0) : glm::normalize(vec3(normal));
    }
}

void reorderVertices(Mesh& mesh, std::span<const uint32_t> order) {
    reorder(mesh.positions, order);
    reorder(mesh.normals, order);
    reorder(mesh.uvs, order);
    reorder(mesh.colors, order);
    reorder(mesh.tangents, order);
}

void append(Mesh& mesh, const Mesh& other) {
    const size_t count = mesh.vertexCount(), otherCount = other.vertexCount();
    RELUME_CHECK_LE(count + otherCount, size_t(std::numeric_limits<uint32_t>::max()));
    const uvec3 first{uint32_t(count)};
    appendAttribute(mesh.normals, count, other.normals, otherCount);
    appendAttribute(mesh.uvs, count, other.uvs, otherCount);
    appendAttribute(mesh.colors, count, other.colors, otherCount);
    appendAttribute(mesh.tangents, count, other.tangents, otherCount);
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.triangles.reserve(mesh.triangleCount() + other.triangleCount());
    for (const uvec3& triangle : other.triangles) mesh.triangles.push_back(triangle + first);
}

} // namespace relume
