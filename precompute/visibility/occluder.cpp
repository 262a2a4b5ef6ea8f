#include "precompute/visibility/occluder.h"

#include "engine/base/log.h"
#include "precompute/visibility/flat_mesh.h"

#include <algorithm>
#include <fmt/core.h>
#include <meshoptimizer.h>

namespace relume {
namespace {

constexpr size_t kFewestTriangles = 4; // of a simplified part: a tetrahedron

// Returns the part's surface without attributes that only shading needs. Vertices are welded by position
// alone, so that creases of the normals do not tear when simplified.
Mesh weldedSurface(const Mesh& mesh) {
    std::vector<unsigned> remap(mesh.vertexCount());
    const size_t count = meshopt_generateVertexRemap<uint32_t>(
        remap.data(), nullptr, mesh.vertexCount(), mesh.positions.data(), mesh.vertexCount(), sizeof(vec3));
    Mesh welded;
    welded.positions.resize(count);
    for (size_t i = 0; i < remap.size(); i++) welded.positions[remap[i]] = mesh.positions[i];
    for (const uvec3& t : mesh.triangles) {
        const uvec3 triangle(remap[t.x], remap[t.y], remap[t.z]);
        if (triangle.x != triangle.y && triangle.y != triangle.z && triangle.z != triangle.x)
            welded.triangles.push_back(triangle);
    }
    return welded;
}

// Simplifies to about `target` triangles; returns meshoptimizer's error in world units.
float simplify(Mesh& mesh, size_t target) {
    std::vector<uint32_t> indices(mesh.triangleCount() * 3);
    const auto* source = &mesh.triangles[0].x;
    const float* positions = &mesh.positions[0].x;
    float error = 0;
    // Allow an error as large as the mesh itself, so that the target alone decides.
    indices.resize(meshopt_simplify(indices.data(), source, indices.size(), positions, mesh.vertexCount(),
                                    sizeof(vec3), 3 * target, 1.0f, 0, &error));
    error *= meshopt_simplifyScale(positions, mesh.vertexCount(), sizeof(vec3));
    if (indices.empty()) return 0; // smaller than its own error; stays as it was

    Mesh fewer;
    fewer.positions.resize(mesh.vertexCount());
    fewer.positions.resize(meshopt_optimizeVertexFetch(fewer.positions.data(), indices.data(), indices.size(),
                                                       positions, mesh.vertexCount(), sizeof(vec3)));
    for (size_t i = 0; i < indices.size(); i += 3)
        fewer.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    mesh = std::move(fewer);
    return error;
}

} // namespace

Occluder makeOccluder(const Scene& scene, size_t triangleBudget) {
    std::vector<Mesh> surfaces;
    std::vector<bool> isReduced;
    size_t reduced = 0, reducible = 0;
    for (const Part& part : scene.parts) {
        surfaces.push_back(weldedSurface(part.mesh));
        std::optional<Mesh> flat = reduceFlat(surfaces.back());
        isReduced.push_back(flat.has_value());
        if (flat) surfaces.back() = std::move(*flat);
        (flat ? reduced : reducible) += surfaces.back().triangleCount();
    }

    Occluder occluder;
    const bool isOver = triangleBudget > 0 && reduced + reducible > triangleBudget;
    const double share =
        isOver ? double(triangleBudget - std::min(reduced, triangleBudget)) / double(reducible) : 1;
    for (size_t i = 0; i < surfaces.size(); i++) {
        Mesh& surface = surfaces[i];
        const size_t target = std::max(size_t(share * double(surface.triangleCount())), kFewestTriangles);
        if (isOver && !isReduced[i] && surface.triangleCount() > target)
            occluder.error = std::max(occluder.error, simplify(surface, target));
        append(occluder.mesh, surface);
    }
    if (isOver && double(occluder.mesh.triangleCount()) > 1.2 * double(triangleBudget))
        log(LogLevel::Warning,
            fmt::format(
                "the occluder keeps {} triangles, more than the {} asked for: its topology allows no fewer",
                occluder.mesh.triangleCount(), triangleBudget));
    return occluder;
}

float visibilityOffset(const Occluder& occluder, const Bounds& scene) {
    return std::max(occluder.error, 1e-4f * scene.radius());
}

} // namespace relume
