#include "engine/render/triangle_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <limits>

namespace relume {

namespace {

// Smaller clusters cull more triangles but take more draws (docs/view_speed.md).
constexpr uint32_t kClusterTriangles = 64;
// Bound on rounding errors relative to the terms of a clip coordinate, including errors of computing with it.
constexpr float kRounding = 0x1p-20f;

struct Triangle {
    std::array<glm::dvec3, 3> corners;
    double longestEdge() const {
        return std::max({glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                         glm::distance(corners[2], corners[0])});
    }
};

Triangle triangleOf(const Mesh& mesh, uint32_t number) {
    const uvec3 t = mesh.triangles[number];
    return {
        {glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z])}};
}

// Returns the plane of a triangle. A triangle that is a single point is never visible, so it gets a plane
// that always shows its back.
vec4 planeOf(const Triangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const double edge = triangle.longestEdge();
    if (edge == 0) return vec4(vec3(0), std::numeric_limits<float>::max());
    const glm::dvec3 normal = glm::cross(b - a, c - a) / edge;
    return vec4(vec3(normal), float(glm::dot(normal, a)));
}

// Returns normalized planes with all that is visible in front of them, enlarged for rounding. The far plane
// is left out, since cameras put everything in front of it.
std::array<vec4, 5> frustumPlanes(const mat4& clipFromWorld) {
    const mat4 rows = glm::transpose(clipFromWorld);
    std::array<vec4, 5> planes{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                               rows[2]};
    for (vec4& plane : planes) {
        plane /= glm::length(vec3(plane));
        plane.w += 4 * kRounding * std::abs(plane.w);
    }
    return planes;
}

} // namespace

TriangleClusters::TriangleClusters(const Mesh& mesh) {
    const auto triangles = uint32_t(mesh.triangleCount());
    for (uint32_t first = 0; first < triangles; first += kClusterTriangles) {
        Bounds bounds;
        float shortest = std::numeric_limits<float>::max();
        for (uint32_t t = first; t < std::min(first + kClusterTriangles, triangles); t++) {
            const Triangle triangle = triangleOf(mesh, t);
            for (const glm::dvec3& corner : triangle.corners) bounds.add(vec3(corner));
            if (const double edge = triangle.longestEdge(); edge > 0)
                shortest = std::min(shortest, float(edge));
            mPlanes.push_back(planeOf(triangle));
        }
        const vec3 center = bounds.center();
        const float radius = 1.0001f * bounds.radius() + 4 * kRounding * glm::length(center);
        mClusters.push_back({center, radius, shortest});
    }
}

// Twice a triangle's area in the image is focal length² · (its plane's height above the eye) / (product of
// its corners' depths). The device rounds each corner's position by up to `away`, which changes twice the
// area by less than 6 · away · longest edge + 8 · away². Where the area is larger, its sign is certain.
bool TriangleClusters::showsBacksAlone(size_t number, const ClusterView& view) const {
    const size_t first = number * kClusterTriangles;
    const size_t end = std::min(first + kClusterTriangles, mPlanes.size());
    const auto height = [&](size_t t) { return mPlanes[t].w - glm::dot(vec3(mPlanes[t]), view.eye); };
    if (!(height(first) > 0)) return false; // rejects most clusters that show fronts
    const Cluster& cluster = mClusters[number];
    const vec3 forward(glm::row(view.clipFromWorld, 3));
    const float depth = glm::dot(forward, cluster.center - view.eye);
    const float nearest = depth - cluster.radius, farthest = depth + cluster.radius;
    if (!(nearest > 0)) return false;
    // Factor by which lengths in the image may exceed those that depth alone gives.
    const float aslant = 1 + (glm::distance(cluster.center, view.eye) + cluster.radius) / nearest;
    const float reach = glm::length(view.eye) + glm::length(cluster.center) + cluster.radius;
    const float away = view.pixelFraction / view.focalLength + kRounding * aslant * reach / nearest;
    const float least =
        farthest * farthest * farthest * (6 * away * aslant / nearest + 8 * away * away / cluster.shortest);
    for (size_t t = first; t < end; t++)
        if (!(height(t) > least)) return false;
    return true;
}

std::vector<TriangleRun> TriangleClusters::visible(const ClusterView& view) const {
    const std::array<vec4, 5> planes = frustumPlanes(view.clipFromWorld);
    std::vector<TriangleRun> runs;
    for (size_t i = 0; i < mClusters.size(); i++) {
        const Cluster& cluster = mClusters[i];
        const bool isBeyondOne = std::ranges::any_of(planes, [&](const vec4& plane) {
            return glm::dot(vec3(plane), cluster.center) + plane.w < -cluster.radius;
        });
        if (isBeyondOne || (view.hidesBacks && showsBacksAlone(i, view))) continue;
        const auto first = uint32_t(i * kClusterTriangles);
        const uint32_t end = std::min(first + kClusterTriangles, uint32_t(mPlanes.size()));
        if (!runs.empty() && runs.back().first + runs.back().count == first)
            runs.back().count += end - first;
        else
            runs.push_back({first, end - first});
    }
    return runs;
}

} // namespace relume
