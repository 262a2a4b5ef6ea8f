// A wrapper of Embree that tells whether a ray is occluded, and what it hits.
//
// Rays extend from their origin (distance 0) to infinity and hit both sides of triangles. Self-hits are not
// excluded: callers lift origins off surfaces. The same rays give the same results, whatever the threads.
#pragma once

#include "engine/scene/mesh.h"

#include <memory>
#include <optional>
#include <span>

namespace relume {

struct RayHit {
    uint32_t mesh;     // index of the mesh
    uint32_t triangle; // index into the mesh's triangles
    vec3 weights;      // barycentric weights of the triangle's corners
    float distance;
};

// Returns whether a ray hits the front of a triangle: the side of the interpolated normal, with which the
// winding need not agree.
bool meetsFront(const Mesh& mesh, const RayHit& hit, vec3 direction);

class RayTracer {
  public:
    // Builds the acceleration structure and keeps no reference to `meshes`, any of which may be empty. Throws
    // Error if Embree fails.
    explicit RayTracer(std::span<const Mesh* const> meshes);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;

    // Returns the nearest hit. Its distance is in units of the length of `direction`. Thread-safe.
    std::optional<RayHit> intersect(vec3 origin, vec3 direction) const;

    // Returns whether a ray hits anything. Thread-safe.
    bool occluded(vec3 origin, vec3 direction) const;

    // Sets blocked[i] to whether a ray from `origin` along directions[i] hits anything. Fastest if
    // consecutive directions are coherent. Thread-safe.
    void occluded(vec3 origin, std::span<const vec3> directions, std::span<uint8_t> blocked) const;

    // Does the same for at most kStream directions, in separate arrays of reach.size() values, without
    // copying. Rays with an infinite `reach` are traced, those with a negative one skipped; `reach` becomes
    // -infinity where something is hit. Thread-safe.
    static constexpr size_t kStream = 256;
    void occluded(vec3 origin, const float* x, const float* y, const float* z, std::span<float> reach) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace relume
