#include "engine/import/mesh_cleanup.h"

#include "engine/base/error.h"
#include "engine/base/log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <numeric>
#include <tuple>

namespace relume {
namespace {

constexpr uint32_t kUnused = 0xffffffff;

template <typename Vector>
bool isFinite(const Vector& v) {
    for (int i = 0; i < v.length(); i++)
        if (!std::isfinite(v[i])) return false;
    return true;
}

// Drops an attribute that not every vertex has; throws if one of its values is not finite.
template <typename Vector>
void checkAttribute(std::vector<Vector>& values, const Mesh& mesh, const char* what,
                    const std::string& name) {
    if (values.size() != mesh.vertexCount()) values.clear();
    for (size_t i = 0; i < values.size(); i++)
        if (!isFinite(values[i]))
            throw Error(
                fmt::format("{}: vertex {} (counted from 0) has {} that are not finite: repair or drop them "
                            "before export",
                            name, i, what));
}

void checkMesh(const Mesh& mesh, const std::string& name) {
    if (mesh.triangles.empty())
        throw Error(fmt::format("{}: holds no triangles: expected a surface to bake", name));
    if (mesh.vertexCount() > kMostMeshVertices || mesh.triangleCount() > kMostMeshTriangles)
        throw Error(
            fmt::format("{}: holds {} vertices and {} triangles, more than the {} supported: simplify it",
                        name, mesh.vertexCount(), mesh.triangleCount(), kMostMeshTriangles));
    for (size_t i = 0; i < mesh.triangleCount(); i++)
        for (int corner = 0; corner < 3; corner++)
            if (mesh.triangles[i][corner] >= mesh.vertexCount())
                throw Error(fmt::format(
                    "{}: triangle {} refers to vertex {}, but there are only {} (both counted from "
                    "0): the file is corrupt",
                    name, i, mesh.triangles[i][corner], mesh.vertexCount()));
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        const vec3 p = mesh.positions[i];
        if (!isFinite(p) || glm::any(glm::greaterThan(glm::abs(p), vec3(kLargestCoordinate))))
            throw Error(
                fmt::format("{}: vertex {} (counted from 0) is at ({}, {}, {}): expected finite coordinates "
                            "within ±{:g}",
                            name, i, p.x, p.y, p.z, kLargestCoordinate));
    }
}

// Normalizes normals; drops all of them if one that is used has no direction.
void normalizeNormals(Mesh& mesh, const std::string& name) {
    if (mesh.normals.empty()) return;
    std::vector<bool> isUsed(mesh.vertexCount(), false);
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) isUsed[triangle[corner]] = true;
    size_t bad = mesh.normals.size() == mesh.vertexCount() ? 0 : mesh.vertexCount();
    for (size_t i = 0; bad == 0 && i < mesh.vertexCount(); i++) {
        const glm::dvec3 normal(mesh.normals[i]);
        const double length = glm::length(normal);
        const bool isDirection = isFinite(mesh.normals[i]) && length > 1e-12;
        if (isUsed[i] && !isDirection) bad++;
        mesh.normals[i] = isDirection ? vec3(normal / length) : vec3(0, 1, 0);
    }
    if (bad == 0) return;
    log(LogLevel::Info,
        fmt::format("{}: some vertices have no usable normal: smooth normals are made for all", name));
    mesh.normals.clear();
}

// Makes tangents unit length and orthogonal to the normals; drops all of them if none has a direction. A
// single one without a direction is replaced by the s axis of the normal's frame.
void normalizeTangents(Mesh& mesh) {
    const auto isDirection = [](vec3 t) { return isFinite(t) && glm::dot(t, t) > 1e-12f; };
    if (mesh.tangents.size() != mesh.vertexCount() || std::ranges::none_of(mesh.tangents, isDirection))
        mesh.tangents.clear();
    for (size_t i = 0; i < mesh.tangents.size(); i++) {
        const vec3 tangent = mesh.tangents[i];
        mesh.tangents[i] =
            tangentFrame(mesh.normals[i], isDirection(tangent) ? glm::normalize(tangent) : vec3(0)).s;
    }
}

// Merges equal vertices into the first of them, whose tangent is kept.
void weld(Mesh& mesh) {
    // Turns negative zero, which compares equal but has other bits, into positive zero.
    for (vec3& position : mesh.positions) position += 0.0f;
    for (vec3& normal : mesh.normals) normal += 0.0f;
    for (vec2& uv : mesh.uvs) uv += 0.0f;
    for (vec4& color : mesh.colors) color += 0.0f;
    const auto key = [&](uint32_t i) {
        const vec3 p = mesh.positions[i], n = mesh.normals.empty() ? vec3(0) : mesh.normals[i];
        const vec2 t = mesh.uvs.empty() ? vec2(0) : mesh.uvs[i];
        const vec4 c = mesh.colors.empty() ? vec4(0) : mesh.colors[i];
        return std::array{p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y, c.x, c.y, c.z, c.w};
    };
    // Sort rather than hash: sorting has no worst case that a hostile file could provoke.
    std::vector<uint32_t> order(mesh.vertexCount());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    std::vector<uint32_t> first(mesh.vertexCount());
    for (size_t i = 0; i < order.size(); i++)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    for (uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) triangle[corner] = first[triangle[corner]];
}

bool isDegenerate(const Mesh& mesh, uvec3 triangle) {
    const glm::dvec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y];
    const glm::dvec3 c = mesh.positions[triangle.z];
    return glm::cross(b - a, c - a) == glm::dvec3(0);
}

// Drops vertices that no triangle uses; keeps the order of the others.
void dropUnused(Mesh& mesh) {
    std::vector<uint32_t> renumbered(mesh.vertexCount(), kUnused), order;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) renumbered[triangle[corner]] = 0;
    for (uint32_t i = 0; i < renumbered.size(); i++) {
        if (renumbered[i] == kUnused) continue;
        renumbered[i] = uint32_t(order.size());
        order.push_back(i);
    }
    reorderVertices(mesh, order);
    for (uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) triangle[corner] = renumbered[triangle[corner]];
}

} // namespace

Mesh cleanUp(Mesh mesh, const std::string& name) {
    checkMesh(mesh, name);
    normalizeNormals(mesh, name);
    checkAttribute(mesh.uvs, mesh, "texture coordinates", name);
    checkAttribute(mesh.colors, mesh, "colors", name);
    for (vec4& color : mesh.colors) color = glm::clamp(color, 0.0f, 1.0f);
    weld(mesh);
    const size_t degenerate =
        std::erase_if(mesh.triangles, [&](const uvec3& triangle) { return isDegenerate(mesh, triangle); });
    if (degenerate > 0)
        log(LogLevel::Info, fmt::format("{}: dropped {} degenerate triangles", name, degenerate));
    if (mesh.triangles.empty())
        throw Error(
            fmt::format("{}: all of its {} triangles are degenerate: expected a surface", name, degenerate));
    dropUnused(mesh);
    const vec3 extent = boundsOf(mesh).extent();
    if (std::max({extent.x, extent.y, extent.z}) < kSmallestExtent)
        throw Error(fmt::format("{}: is less than {:g} units across: scale it up before export", name,
                                kSmallestExtent));
    if (mesh.normals.empty()) makeNormals(mesh);
    normalizeTangents(mesh);
    return mesh;
}

} // namespace relume
