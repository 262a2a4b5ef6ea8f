// Transport at arbitrary points as a bake evaluates it, before selection and quantization.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/transport/asset.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/error/lit_cells.h"

#include <functional>

namespace relume {

class BakedTransport {
  public:
    // Keeps a reference to `asset`, whose transport it does not use. Throws Error if Embree fails.
    explicit BakedTransport(const Asset& asset);

    const CubeCells& lighting() const { return mLighting; } // F² cells per face

    // Returns the visibility bits of the asset's occluder, from as far above the point as in the bake, in the
    // order of CpuVisibility. `normal` is a unit vector.
    std::vector<uint64_t> visibility(vec3 position, vec3 normal) const;
    size_t visibilityWords() const { return mVisibility.texels() / 64; }
    // Returns the cells that can light a point with these visibility bits and this frame.
    std::vector<LitCell> lit(std::span<const uint64_t> visibility, const TangentFrame& frame) const;

    // Computes all 6 F² Haar coefficients of a vertex's transport with the factors `brdf`, and calls
    // use(term, coefficients) for each term.
    void forEachTerm(size_t part, uint32_t vertex, const FactoredBrdf& brdf,
                     const std::function<void(size_t, const std::vector<vec3>&)>& use) const;

  private:
    const Asset& mAsset;
    CubeCells mLighting, mEvaluations;
    CpuVisibility mVisibility;
};

// Returns all 6 F² Haar coefficients of a light vector, zero where it has no entry.
std::vector<vec3> dequantizedLight(const LightVector& light);

} // namespace relume
