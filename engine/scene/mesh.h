// Triangle meshes, in the form that every stage takes: welded, validated, with unit normals.
#pragma once

#include "engine/math/tangent_frame.h"

#include <limits>
#include <span>
#include <vector>

namespace relume {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<vec3> normals;     // one per position, unit length; may be empty for an occluder
    std::vector<uvec3> triangles;  // counter-clockwise seen from outside; indices into positions
    std::vector<vec2> uvs = {};    // empty or one per position: (0, 0) is an image's top left, v goes down
    std::vector<vec4> colors = {}; // empty or one per position: linear, in [0, 1]
    // Empty or one per position: s of the vertex's tangent frame, unit and orthogonal to the normal.
    std::vector<vec3> tangents = {};

    size_t vertexCount() const { return positions.size(); }
    size_t triangleCount() const { return triangles.size(); }
};

// The attributes that a reader keeps besides position and normal. Each splits vertices along its seams, and
// every vertex costs bake time: keep those alone that something uses.
struct MeshAttributes {
    bool uvs = false, colors = false;
};

// An axis-aligned box; empty until a point is added.
struct Bounds {
    vec3 low = vec3(std::numeric_limits<float>::max());
    vec3 high = vec3(std::numeric_limits<float>::lowest());

    void add(vec3 point) { low = glm::min(low, point), high = glm::max(high, point); }
    void add(const Bounds& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
    vec3 center() const { return 0.5f * (low + high); }
    vec3 extent() const { return high - low; }
    // Returns the radius of the sphere around the box, which serves as the scene's unit of length.
    float radius() const { return 0.5f * glm::length(extent()); }
};

// Returns the bounds of all positions.
Bounds boundsOf(const Mesh& mesh);

// Returns the frame in which a vertex's transport is baked: that of its tangent, or of its normal alone if
// the mesh has no tangents.
TangentFrame frameOf(const Mesh& mesh, size_t vertex);

// Computes `normals` as sums of face normals weighted by the corner's angle (Thürmer and Wüthrich 1998).
void makeNormals(Mesh& mesh);

// Moves vertex order[i], with all its attributes, to index i. The caller renumbers the triangles.
void reorderVertices(Mesh& mesh, std::span<const uint32_t> order);

// Appends `other`'s vertices and triangles. An attribute is kept only if both meshes have it.
void append(Mesh& mesh, const Mesh& other);

} // namespace relume
