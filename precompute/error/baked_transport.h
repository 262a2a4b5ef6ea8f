// What a bake finds at a point, before any of it is dropped.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/asset.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/error/lit_cells.h"

#include <functional>

namespace relume {

class BakedTransport {
  public:
    // Refers to `asset`, of whose transport it knows nothing. Throws Error when Embree fails.
    explicit BakedTransport(const Asset& asset);

    const CubeCells& lighting() const { return mLighting; } // F² a face

    // Bits of the occluder's visibility, from as high above the point as the bake's are, in the order of
    // CpuVisibility. `normal` is unit.
    std::vector<uint64_t> visibility(vec3 position, vec3 normal) const;
    size_t visibilityWords() const { return mVisibility.texels() / 64; }
    // Of such bits, of a point with this frame.
    std::vector<LitCell> lit(std::span<const uint64_t> visibility, const TangentFrame& frame) const;

    // All 6 F² Haar coefficients of a vertex's transport, with a set's factors: calls use(term, coefficients)
    // for one term after another.
    void forEachTerm(size_t part, uint32_t vertex, const FactoredBrdf& brdf,
                     const std::function<void(size_t, const std::vector<vec3>&)>& use) const;

  private:
    const Asset& mAsset;
    CubeCells mLighting, mEvaluations;
    CpuVisibility mVisibility;
};

// The 6 F² Haar coefficients that a vector stands for, zero where it has none.
std::vector<vec3> coefficientsOf(const LightVector& light);

} // namespace relume
