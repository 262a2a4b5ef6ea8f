// Finds the surfaces that a vertex sees along its rays and that light it by reflection.
#pragma once

#include "engine/render/appearance.h"
#include "engine/transport/asset.h"
#include "precompute/visibility/ray_tracer.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace relume {

// Returns, per channel, the share of uniform light that a layer's terms reflect (their mean albedo). At most
// 1 for an energy-conserving BRDF, but factors may exceed it.
vec3 reflectedShare(const FactoredBrdf& brdf, int layer);

// Returns the factor for a layer's view maps where it lights others: 1, or what reduces a larger share to 1,
// so that bounces converge.
vec3 sourceGain(vec3 reflectedShare);

// Returns the gains of the layers that `bound` binds, per part and bound layer.
std::vector<std::vector<vec3>> sourceGains(const Asset& asset, const Appearance& bound);

// A surface that a ray of a vertex hits.
struct BounceHit {
    uint32_t part, vertex; // the vertex whose rows represent the surface
    vec3 direction;        // of the ray, in the frame of the vertex that sent it; unit length
    // The view maps, in 1/sr, towards the ray's origin: per term of the part's bound set.
    std::array<vec3, kMostTerms> views;
};

// Finds hits for all vertices of an asset. Thread-safe.
class BounceHits {
  public:
    // Every part lights others with the materials bound in `bound`, times their sourceGains(). Keeps a
    // reference to `asset`, whose transport it does not use. Throws Error if Embree fails.
    BounceHits(const Asset& asset, const Appearance& bound);

    const Asset& asset() const { return mAsset; }

    // A layer whose gain is below 1.
    struct HeldLayer {
        size_t part;
        int layer;   // of the bound set
        float share; // reflected share without the gain, largest over channels
    };
    const std::vector<HeldLayer>& heldLayers() const { return mHeld; }

    static constexpr size_t kRays = 1024; // of each vertex, cosine-distributed

    // Calls take(hit) for each ray of a vertex that meets the front of a surface, in the order of the rays.
    void find(size_t part, uint32_t vertex, const std::function<void(const BounceHit&)>& take) const;

    // Looks up the light maps of all sets of a part for a ray's direction, times the cosine and solid angle
    // that a ray stands for. `light` has the part's termCount().
    void lookupLight(size_t part, vec3 direction, std::span<vec3> light) const;

  private:
    bool find(vec3 origin, vec3 direction, float choice, BounceHit& hit) const;

    const Asset& mAsset;
    Appearance mBound;
    std::vector<std::vector<vec3>> mGains;        // per part and bound layer
    std::vector<std::vector<BoundLayer>> mLayers; // per part: the layers that light others
    std::vector<HeldLayer> mHeld;
    RayTracer mTracer; // one mesh per part
};

} // namespace relume
