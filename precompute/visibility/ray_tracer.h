// Embree behind two questions: is a ray blocked, and what does it hit.
//
// Rays go from their origin (distance 0) to infinity and meet both sides of a triangle. No self-hit is
// excluded: whoever starts on a surface lifts the origin off it. The same rays give the same answers,
// whatever the threads.
#pragma once

#include "engine/scene/mesh.h"

#include <memory>
#include <optional>
#include <span>

namespace relume {

struct RayHit {
    uint32_t mesh;     // index of the mesh it belongs to
    uint32_t triangle; // index into that mesh's triangles
    vec3 weights;      // barycentric weights of the triangle's corners
    float distance;
};

// Returns whether a ray meets the front of a hit's triangle in its mesh: the side that the interpolated
// normal is on, with which windings need not agree.
bool meetsFront(const Mesh& mesh, const RayHit& hit, vec3 direction);

class RayTracer {
  public:
    // Builds the acceleration structure; keeps no reference to `meshes`, any of which may be empty. Throws
    // Error when Embree fails.
    explicit RayTracer(std::span<const Mesh* const> meshes);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;

    // The nearest hit. `direction` sets the unit of the distance. Thread-safe.
    std::optional<RayHit> intersect(vec3 origin, vec3 direction) const;

    // Whether a ray hits anything. Thread-safe.
    bool occluded(vec3 origin, vec3 direction) const;

    // blocked[i] = whether a ray from `origin` along directions[i] hits anything. Coherent directions
    // in sequence are fastest. Thread-safe.
    void occluded(vec3 origin, std::span<const vec3> directions, std::span<uint8_t> blocked) const;

    // The same for at most kStream directions in separate arrays of reach.size() values, without copying
    // them. A ray is traced where `reach` is infinite and left out where it is negative; -infinity comes back
    // where something is hit. Thread-safe.
    static constexpr size_t kStream = 256;
    void occluded(vec3 origin, const float* x, const float* y, const float* z, std::span<float> reach) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace relume
