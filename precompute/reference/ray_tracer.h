// Embree behind two questions: is a ray blocked, and what does it hit.
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

class RayTracer {
  public:
    // Builds the acceleration structure; keeps no reference to `meshes`.
    explicit RayTracer(std::span<const Mesh* const> meshes);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;

    std::optional<RayHit> intersect(vec3 origin, vec3 direction) const;

    // blocked[i] = whether a ray from `origin` along directions[i] hits anything. Coherent directions
    // in sequence are fastest. Thread-safe.
    void occluded(vec3 origin, std::span<const vec3> directions, std::span<uint8_t> blocked) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace relume
