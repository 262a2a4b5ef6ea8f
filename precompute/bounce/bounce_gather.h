// Gathers one bounce of light: the transport of every vertex by way of the surfaces that it sees.
//
// For vertex x, term k and each direction ω in which x sees a point y of another surface:
//
//     T'[x, k] = ∫ g_k(ω) cosθ · Σ_m h_m(−ω at y) T[y, m] dω,
//
// where T are the rows at y of the material that lights others, and g and h are light and view maps
// (docs/bounces.md). All of it is linear in the lighting, so bounced rows are added to the directly baked
// ones.
#pragma once

#include "engine/render/appearance.h"
#include "engine/transport/rows/sparse_transport.h"
#include "precompute/visibility/ray_tracer.h"

#include <functional>

namespace relume {

// Bounced light has a lower resolution than the lighting cube: texels per side of a face.
constexpr int kBounceFaceSize = 16;
constexpr int kBounceCoefficients = 6 * kBounceFaceSize * kBounceFaceSize;
constexpr int kBounceKept = 64; // row entries of bounced light, at most

// Returns the index in a cube of kBounceFaceSize of a coefficient (face · size² + y · size + x) of a larger
// cube, or nothing if it is too fine. The Haar basis is nested: the coefficients of a cube of n texels per
// side are the first n × n of every face of the larger one, times size / n.
std::optional<uint16_t> bounceCoefficient(uint16_t coefficient, int size);
// Returns the index in a cube of `size` texels per side of a coefficient of kBounceFaceSize.
uint16_t coefficientOfBounce(uint16_t coefficient, int size);

// Returns, per channel, the share of uniform light that a layer's terms reflect (their mean albedo). At most
// 1 for an energy-conserving BRDF, but factors may exceed it.
vec3 reflectedShare(const FactoredBrdf& brdf, int layer);

// Returns the factor for a layer's view maps where it lights others: 1, or what reduces a larger share to 1,
// so that bounces converge.
vec3 sourceGain(vec3 reflectedShare);

// Returns the gains of the layers that `bound` binds, per part and bound layer.
std::vector<std::vector<vec3>> sourceGains(const Asset& asset, const Appearance& bound);

// Gathers bounced light for all vertices of an asset.
class BounceGather {
  public:
    // Every part lights others with the materials bound in `bound`, times their sourceGains(). Keeps a
    // reference to `asset`, whose transport it does not use. Throws Error if Embree fails.
    BounceGather(const Asset& asset, const Appearance& bound);

    // A layer whose gain is below 1.
    struct HeldLayer {
        size_t part;
        int layer;   // of the bound set
        float share; // reflected share without the gain, largest over channels
    };
    const std::vector<HeldLayer>& heldLayers() const { return mHeld; }

    // Called with the number of vertices done; returns whether to go on.
    using Report = std::function<bool(uint64_t vertices)>;

    // Gathers rows per part and set, from the rows of the bound sets, `from`, one per part; all are
    // coefficients of kBounceFaceSize. The result does not depend on the number of threads. Returns nothing
    // if stopped.
    std::vector<std::vector<SparseTransport>> gather(std::span<const SparseTransport> from,
                                                     const Report& report) const;

  private:
    struct Hit;
    struct Room;
    void gatherVertex(size_t part, uint32_t vertex, std::span<const SparseTransport> from, Room& room,
                      std::span<SparseTransport> rows) const;
    bool find(vec3 origin, vec3 direction, float choice, Hit& hit) const;

    const Asset& mAsset;
    Appearance mBound;
    std::vector<std::vector<vec3>> mGains;        // per part and bound layer
    std::vector<std::vector<BoundLayer>> mLayers; // per part: the layers that light others
    std::vector<HeldLayer> mHeld;
    RayTracer mTracer; // one mesh per part
};

} // namespace relume
