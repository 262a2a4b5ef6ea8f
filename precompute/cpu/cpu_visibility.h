// Visibility cubes by Embree, in streams of coherent rays.
#pragma once

#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Bits of a cube in the CPU baker's order: face after face, each along mortonPlace; bit i of a word is texel
// i of its 64.
class CpuVisibility {
  public:
    // Faces of size² texels: a power of two, 16 or more.
    CpuVisibility(const Mesh& occluder, int size);

    size_t texels() const { return mX.size(); }

    // Sets the bit of every texel whose direction is above the horizon of `normal` and free: visibilityCube
    // in precompute/twins/transport_twin.h. `bits` has texels() / 64 words. Returns the number of rays.
    uint64_t trace(vec3 origin, vec3 normal, std::span<uint64_t> bits) const;

  private:
    RayTracer mTracer;
    std::vector<float> mX, mY, mZ; // unit directions
};

} // namespace relume
