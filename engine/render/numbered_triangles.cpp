#include "engine/render/numbered_triangles.h"

#include <limits>

namespace relume {

NumberedTriangles numberTriangles(const Mesh& mesh) {
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    NumberedTriangles numbered;
    std::vector<uint32_t> copies(mesh.vertexCount(), kNone); // one of each vertex that has any
    for (const uvec3& triangle : mesh.triangles) {
        // A vertex without a copy first, so that few are needed in the end.
        int first = 0;
        while (first < 2 && copies[triangle[first]] != kNone) first++;
        if (copies[triangle[first]] != kNone) first = 0;
        const auto number = uint32_t(numbered.positions.size());
        numbered.positions.push_back(mesh.positions[triangle[first]]);
        copies[triangle[first]] = number;
        // Of the mesh's vertices for now, but for the first.
        numbered.triangles.emplace_back(number, triangle[(first + 1) % 3], triangle[(first + 2) % 3]);
    }
    for (uvec3& triangle : numbered.triangles)
        for (int c = 1; c < 3; c++) {
            uint32_t& copy = copies[triangle[c]];
            if (copy == kNone) {
                copy = uint32_t(numbered.positions.size());
                numbered.positions.push_back(mesh.positions[triangle[c]]);
            }
            triangle[c] = copy;
        }
    return numbered;
}

} // namespace relume
