// Triangle meshes, as every stage sees them: welded, validated, with unit normals.
#pragma once

#include "engine/math/vector.h"

#include <limits>
#include <vector>

namespace relume {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<vec3> normals;    // One per position, unit length; may be empty for an occluder.
    std::vector<uvec3> triangles; // Counter-clockwise seen from outside; indices into positions.

    size_t vertexCount() const { return positions.size(); }
    size_t triangleCount() const { return triangles.size(); }
};

// An axis-aligned box; empty until a point is added.
struct Bounds {
    vec3 low = vec3(std::numeric_limits<float>::max());
    vec3 high = vec3(std::numeric_limits<float>::lowest());

    void add(vec3 point) { low = glm::min(low, point), high = glm::max(high, point); }
    void add(const Bounds& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
    vec3 centre() const { return 0.5f * (low + high); }
    vec3 extent() const { return high - low; }
    // Radius of the sphere around the box: the scene's unit of length.
    float radius() const { return 0.5f * glm::length(extent()); }
};

Bounds boundsOf(const Mesh& mesh);

// Fills `normals` by summing face normals weighted with the corner's angle (Thürmer and Wüthrich 1998).
void makeNormals(Mesh& mesh);

// Appends `other`'s vertices and triangles; normals are kept only if both meshes have them.
void append(Mesh& mesh, const Mesh& other);

} // namespace relume
