#include "engine/scene/mesh_cleanup.h"

#include "engine/base/error.h"

#include <algorithm>
#include <numeric>
#include <spdlog/spdlog.h>
#include <tuple>

namespace relume {
namespace {

constexpr uint32_t kUnused = 0xffffffff;

// Squares and products of four lengths must stay inside single precision.
constexpr float kLargestCoordinate = 1e9f, kSmallestExtent = 1e-9f;

bool isFinite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void checkMesh(const Mesh& mesh, const std::string& name) {
    if (mesh.triangles.empty()) throw Error("{}: holds no triangles: expected a surface to bake", name);
    if (mesh.vertexCount() > kMostMeshVertices || mesh.triangleCount() > kMostMeshTriangles)
        throw Error("{}: holds {} vertices and {} triangles, more than the {} supported: simplify it", name,
                    mesh.vertexCount(), mesh.triangleCount(), kMostMeshTriangles);
    for (size_t i = 0; i < mesh.triangleCount(); i++)
        for (int corner = 0; corner < 3; corner++)
            if (mesh.triangles[i][corner] >= mesh.vertexCount())
                throw Error("{}: triangle {} refers to vertex {}, but there are only {} (both counted from "
                            "0): the file is corrupt",
                            name, i, mesh.triangles[i][corner], mesh.vertexCount());
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        const vec3 p = mesh.positions[i];
        if (!isFinite(p) || glm::any(glm::greaterThan(glm::abs(p), vec3(kLargestCoordinate))))
            throw Error("{}: vertex {} (counted from 0) is at ({}, {}, {}): expected finite coordinates "
                        "within ±{:g}",
                        name, i, p.x, p.y, p.z, kLargestCoordinate);
    }
}

// Makes normals unit length, or drops all of them if one that is used is no direction.
void normaliseNormals(Mesh& mesh, const std::string& name) {
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
    spdlog::info("{}: some vertices have no usable normal: smooth normals are made for all", name);
    mesh.normals.clear();
}

// Gives vertices that are equal the number of the first of them.
void weld(Mesh& mesh) {
    // Adding zero turns the negative zero, which is equal but has other bits, into the positive one.
    for (vec3& position : mesh.positions) position += 0.0f;
    for (vec3& normal : mesh.normals) normal += 0.0f;
    const auto key = [&](uint32_t i) {
        const vec3 p = mesh.positions[i], n = mesh.normals.empty() ? vec3(0) : mesh.normals[i];
        return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z);
    };
    // Sorting, unlike hashing, has no worst case that a hostile file could ask for.
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

// Drops vertices that no triangle uses, keeping the order of the others.
void dropUnused(Mesh& mesh) {
    std::vector<uint32_t> renumbered(mesh.vertexCount(), kUnused);
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) renumbered[triangle[corner]] = 0;
    uint32_t count = 0;
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        if (renumbered[i] == kUnused) continue;
        mesh.positions[count] = mesh.positions[i];
        if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
        renumbered[i] = count++;
    }
    mesh.positions.resize(count);
    if (!mesh.normals.empty()) mesh.normals.resize(count);
    for (uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; corner++) triangle[corner] = renumbered[triangle[corner]];
}

} // namespace

Mesh cleanUp(Mesh mesh, const std::string& name) {
    checkMesh(mesh, name);
    normaliseNormals(mesh, name);
    weld(mesh);
    const size_t degenerate =
        std::erase_if(mesh.triangles, [&](const uvec3& triangle) { return isDegenerate(mesh, triangle); });
    if (degenerate > 0) spdlog::info("{}: dropped {} degenerate triangles", name, degenerate);
    if (mesh.triangles.empty())
        throw Error("{}: all of its {} triangles are degenerate: expected a surface", name, degenerate);
    dropUnused(mesh);
    const vec3 extent = boundsOf(mesh).extent();
    if (std::max({extent.x, extent.y, extent.z}) < kSmallestExtent)
        throw Error("{}: is less than {:g} units across: scale it up before export", name, kSmallestExtent);
    if (mesh.normals.empty()) makeNormals(mesh);
    return mesh;
}

} // namespace relume
