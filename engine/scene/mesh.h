// Triangle meshes, as every stage sees them: welded, validated, with unit normals.
#pragma once

#include "engine/math/tangent_frame.h"

#include <limits>
#include <span>
#include <vector>

namespace relume {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<vec3> normals;     // One per position, unit length; may be empty for an occluder.
    std::vector<uvec3> triangles;  // Counter-clockwise seen from outside; indices into positions.
    std::vector<vec2> uvs = {};    // Empty or one per position: (0, 0) is an image's top left, v goes down.
    std::vector<vec4> colors = {}; // Empty or one per position: linear, in [0, 1].
    // Empty or one per position, unit length and orthogonal to the normal: s of the vertex's frame.
    std::vector<vec3> tangents = {};

    size_t vertexCount() const { return positions.size(); }
    size_t triangleCount() const { return triangles.size(); }
};

// Attributes beyond position and normal that a reader keeps. Each splits vertices along its seams, and every
// vertex costs time in a bake: so none unless something uses it.
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
    // Radius of the sphere around the box: the scene's unit of length.
    float radius() const { return 0.5f * glm::length(extent()); }
};

Bounds boundsOf(const Mesh& mesh);

// Returns the frame that a vertex's transport is baked in: of its tangent, or of its normal if the mesh has
// none.
TangentFrame frameOf(const Mesh& mesh, size_t vertex);

// Fills `normals` by summing face normals weighted with the corner's angle (Thürmer and Wüthrich 1998).
void makeNormals(Mesh& mesh);

// Makes vertex order[i] vertex i, with all its attributes. Triangles are the caller's to renumber.
void reorderVertices(Mesh& mesh, std::span<const uint32_t> order);

// Appends `other`'s vertices and triangles; attributes are kept only if both meshes have them.
void append(Mesh& mesh, const Mesh& other);

} // namespace relume
