#include "engine/render/numbered_triangles.h"

#include <limits>

namespace relume {

namespace {

constexpr uint32_t kNoCopy = std::numeric_limits<uint32_t>::max();
// Triangles after which a device's vertex cache is assumed to have lost a vertex: about what devices hold; on
// lavapipe it gives the fewest vertices.
constexpr uint32_t kHeld = 32;

// Copy of a vertex, by its index; kNoCopy if none has been made.
struct Copy {
    uint32_t number = kNoCopy, lastTriangle = 0;
};

// Lists the triangles that begin with a vertex: the first one per vertex, the next one per triangle.
struct Beginnings {
    explicit Beginnings(const std::vector<uvec3>& triangles, size_t vertices)
        : next(triangles.size(), kNoCopy), first(vertices, kNoCopy) {
        for (auto t = uint32_t(triangles.size()); t-- > 0;) {
            next[t] = first[triangles[t].x];
            first[triangles[t].x] = t;
        }
    }
    std::vector<uint32_t> next, first;
};

// Returns the triangles with their corners rotated so that few vertices begin none.
std::vector<uvec3> turned(const Mesh& mesh) {
    std::vector<uvec3> triangles;
    triangles.reserve(mesh.triangleCount());
    std::vector<bool> begins(mesh.vertexCount(), false);
    for (const uvec3& triangle : mesh.triangles) {
        int first = 0;
        while (first < 2 && begins[triangle[first]]) first++;
        if (begins[triangle[first]]) first = 0;
        begins[triangle[first]] = true;
        triangles.emplace_back(triangle[first], triangle[(first + 1) % 3], triangle[(first + 2) % 3]);
    }
    return triangles;
}

} // namespace

NumberedTriangles numberTriangles(const Mesh& mesh) {
    NumberedTriangles numbered{{}, turned(mesh)};
    for (const uvec3& triangle : numbered.triangles) numbered.positions.push_back(mesh.positions[triangle.x]);
    auto [next, coming] = Beginnings(numbered.triangles, mesh.vertexCount());
    std::vector<Copy> copies(mesh.vertexCount()); // most recently used copy of each vertex
    for (uint32_t t = 0; t < numbered.triangles.size(); t++) {
        uvec3& triangle = numbered.triangles[t];
        copies[triangle.x] = {t, t};
        coming[triangle.x] = next[t];
        triangle.x = t;
        for (int c = 1; c < 3; c++) {
            const uint32_t vertex = triangle[c];
            Copy& copy = copies[vertex];
            if ((copy.number == kNoCopy || t - copy.lastTriangle > kHeld) && coming[vertex] != kNoCopy)
                copy.number = coming[vertex];
            if (copy.number == kNoCopy) {
                copy.number = uint32_t(numbered.positions.size());
                numbered.positions.push_back(mesh.positions[vertex]);
            }
            copy.lastTriangle = t;
            triangle[c] = copy.number;
        }
    }
    return numbered;
}

} // namespace relume
