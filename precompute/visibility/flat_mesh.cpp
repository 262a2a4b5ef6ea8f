#include "precompute/visibility/flat_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace relume {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kFlatTolerance = 1e-5;

// A flat surface, projected along the normal of its plane.
struct FlatMesh {
    std::vector<dvec2> points; // per vertex
    double area = 0;           // of all triangles
};

std::optional<FlatMesh> flatten(const Mesh& mesh) {
    // Area-weighted mean normal, since rounding tilts that of a small triangle too much.
    dvec3 sum(0);
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        sum += glm::cross(b - a, c - a);
    }
    if (sum == dvec3(0)) return {};
    const dvec3 normal = glm::normalize(sum);
    const dvec3 u =
        glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 0, 1)));
    const dvec3 v = glm::cross(normal, u);

    const vec3 extent = boundsOf(mesh).extent();
    const double limit = kFlatTolerance * std::max({extent.x, extent.y, extent.z});
    dvec3 origin(0);
    for (const vec3& position : mesh.positions) origin += dvec3(position) / double(mesh.vertexCount());
    FlatMesh flat;
    for (const vec3& position : mesh.positions) {
        const dvec3 offset = dvec3(position) - origin;
        if (std::abs(glm::dot(offset, normal)) > limit) return {};
        flat.points.push_back({glm::dot(offset, u), glm::dot(offset, v)});
    }
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const double area = 0.5 * glm::dot(glm::cross(b - a, c - a), normal);
        if (area < 0) return {}; // faces both ways: not a simple polygon
        flat.area += area;
    }
    return flat;
}

double area(dvec2 a, dvec2 b, dvec2 c) {
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

// Returns the indices of the convex hull, counter-clockwise (Andrew's monotone chain, 1979).
std::vector<uint32_t> convexHull(const std::vector<dvec2>& points) {
    std::vector<uint32_t> order(points.size()), hull;
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::tie(points[a].x, points[a].y, a) < std::tie(points[b].x, points[b].y, b);
    });
    for (int side = 0; side < 2; side++) {
        const size_t start = hull.size();
        for (const uint32_t i : order) {
            while (hull.size() >= start + 2 &&
                   area(points[hull[hull.size() - 2]], points[hull.back()], points[i]) <= 0)
                hull.pop_back();
            hull.push_back(i);
        }
        hull.pop_back(); // it also starts the other side
        std::reverse(order.begin(), order.end());
    }
    return hull;
}

double hullArea(const std::vector<dvec2>& points, const std::vector<uint32_t>& hull) {
    double sum = 0;
    for (size_t i = 1; i + 1 < hull.size(); i++)
        sum += area(points[hull[0]], points[hull[i]], points[hull[i + 1]]);
    return sum;
}

// Drops corners that are due to rounding: those whose removal hardly changes the area.
void dropStraightCorners(const std::vector<dvec2>& points, double total, std::vector<uint32_t>& hull) {
    const double limit = 0.01 * kFlatTolerance * total;
    for (size_t i = 0; i < hull.size() && hull.size() > 3;) {
        const size_t last = (i + hull.size() - 1) % hull.size(), next = (i + 1) % hull.size();
        if (area(points[hull[last]], points[hull[i]], points[hull[next]]) <= limit)
            hull.erase(hull.begin() + ptrdiff_t(i));
        else
            i++;
    }
}

} // namespace

std::optional<Mesh> reduceFlat(const Mesh& mesh) {
    const std::optional<FlatMesh> flat = flatten(mesh);
    if (!flat) return {};
    std::vector<uint32_t> hull = convexHull(flat->points);
    const auto fills = [&](const std::vector<uint32_t>& corners) {
        return corners.size() >= 3 &&
               std::abs(hullArea(flat->points, corners) - flat->area) <= kFlatTolerance * flat->area;
    };
    if (!fills(hull)) return {};
    std::vector<uint32_t> fewer = hull;
    dropStraightCorners(flat->points, flat->area, fewer);
    if (fills(fewer)) hull = std::move(fewer);
    if (hull.size() - 2 > mesh.triangleCount()) return {};

    Mesh reduced;
    for (const uint32_t corner : hull) reduced.positions.push_back(mesh.positions[corner]);
    for (uint32_t i = 1; i + 1 < hull.size(); i++) reduced.triangles.push_back({0, i, i + 1});
    return reduced;
}

} // namespace relume
