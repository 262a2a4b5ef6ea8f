#include "engine/import/polygon.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <fmt/core.h>
#include <numeric>

namespace relume {
namespace {

using glm::dvec2;
using glm::dvec3;

// Projects a polygon along the largest component of Newell's normal, so that it is counter-clockwise.
std::vector<dvec2> flatten(std::span<const vec3> corners) {
    dvec3 normal(0);
    for (size_t i = 0; i < corners.size(); i++)
        normal +=
            glm::cross(dvec3(corners[i] - corners[0]), dvec3(corners[(i + 1) % corners.size()] - corners[0]));
    const dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<dvec2> flat;
    for (const vec3& corner : corners)
        flat.push_back(normal[axis] >= 0 ? dvec2(corner[u], corner[v]) : dvec2(corner[v], corner[u]));
    return flat;
}

// Returns twice the signed area of a triangle, positive if it is counter-clockwise.
double area(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool isConvex(const std::vector<dvec2>& flat) {
    const size_t count = flat.size();
    // Turning left at every corner is not enough, since a star does too; nor may the fan fold over.
    for (size_t i = 0; i < count; i++)
        if (area(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) < 0) return false;
    for (size_t i = 1; i + 1 < count; i++)
        if (area(flat[0], flat[i], flat[i + 1]) < 0) return false;
    return true;
}

// Returns whether the ring's corner `at` is an ear: it is convex and no other corner lies inside it.
bool isEar(const std::vector<dvec2>& flat, const std::vector<uint32_t>& ring, size_t at) {
    const size_t count = ring.size();
    const dvec2 a = flat[ring[(at + count - 1) % count]], b = flat[ring[at]],
                c = flat[ring[(at + 1) % count]];
    if (area(a, b, c) <= 0) return false;
    for (size_t i = 2; i + 1 < count; i++) {
        const dvec2 p = flat[ring[(at + i) % count]];
        if (p != a && p != b && p != c && area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0)
            return false;
    }
    return true;
}

void clipEars(const std::vector<dvec2>& flat, std::vector<uvec3>& triangles) {
    std::vector<uint32_t> ring(flat.size());
    std::iota(ring.begin(), ring.end(), 0u);
    while (ring.size() > 3) {
        const size_t count = ring.size();
        size_t ear = 0;
        while (ear < count && !isEar(flat, ring, ear)) ear++;
        // A ring without an ear crosses itself or is collinear; any cut will do.
        if (ear == count) ear = 0;
        triangles.push_back({ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]});
        ring.erase(ring.begin() + ptrdiff_t(ear));
    }
    triangles.push_back({ring[0], ring[1], ring[2]});
}

} // namespace

void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles, const std::string& name) {
    RELUME_CHECK(corners.size() >= 3);
    if (corners.size() == 3) {
        triangles.push_back({0, 1, 2});
        return;
    }
    const std::vector<dvec2> flat = flatten(corners);
    if (!isConvex(flat)) {
        if (corners.size() > kMostConcaveCorners)
            throw Error(fmt::format("{}: a face has {} corners and is concave, which is supported up to {}: "
                                    "triangulate the mesh before export",
                                    name, corners.size(), kMostConcaveCorners));
        clipEars(flat, triangles);
    } else if (corners.size() == 4 &&
               glm::distance(corners[1], corners[3]) < glm::distance(corners[0], corners[2])) {
        triangles.push_back({0, 1, 3});
        triangles.push_back({1, 2, 3});
    } else {
        for (uint32_t i = 1; i + 1 < corners.size(); i++) triangles.push_back({0, i, i + 1});
    }
}

} // namespace relume
