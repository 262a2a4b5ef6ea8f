// Computes visibility cubes with Embree, in streams of coherent rays.
#pragma once

#include "engine/math/vector.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Returns the coordinates of the index-th texel of a cube face in Morton order, in which every aligned square
// whose side is a power of two is contiguous: even bits are x, odd bits y.
inline ivec2 mortonPlace(uint32_t index) {
    const auto evenBits = [](uint32_t bits) {
        bits &= 0x55555555u;
        bits = (bits | bits >> 1) & 0x33333333u;
        bits = (bits | bits >> 2) & 0x0f0f0f0fu;
        bits = (bits | bits >> 4) & 0x00ff00ffu;
        return int((bits | bits >> 8) & 0x0000ffffu);
    };
    return {evenBits(index), evenBits(index >> 1)};
}

// Visibility bits are in Morton order: face after face, each along mortonPlace(); bit i of a word is the i-th
// of its 64 texels.
class CpuVisibility {
  public:
    // Faces have size² texels; `size` is a power of two, at least 16.
    CpuVisibility(const Mesh& occluder, int size);

    size_t texels() const { return mX.size(); }

    // Sets the bit of every texel whose direction is above the horizon of `normal` and unoccluded:
    // visibilityCube() in precompute/twins/transport_twin.h. `bits` has texels() / 64 words. Returns the
    // number of rays traced.
    uint64_t trace(vec3 origin, vec3 normal, std::span<uint64_t> bits) const;

  private:
    RayTracer mTracer;
    std::vector<float> mX, mY, mZ; // unit directions
};

} // namespace relume
