// One bounce of light: the transport of every vertex by way of the surfaces that it sees.
//
// Of vertex x, term k and direction ω, in which it sees the point y of another surface:
//
//     T'[x, k] = ∫ g_k(ω) cosθ · Σ_m h_m(−ω at y) T[y, m] dω,
//
// T being the rows at y of the material that lights others, g and h the light and view maps
// (docs/bounces.md). All of it is linear in the lighting, so that bounced rows are added to those that were
// baked.
#pragma once

#include "engine/render/appearance.h"
#include "engine/transport/rows/sparse_transport.h"
#include "precompute/visibility/ray_tracer.h"

#include <functional>

namespace relume {

// Bounced light is found at a lower resolution of the lighting cube: texels a side of a face.
constexpr int kBounceFaceSize = 16;
constexpr int kBounceCoefficients = 6 * kBounceFaceSize * kBounceFaceSize;
constexpr int kBounceKept = 64; // most coefficients of a bounced row

// Returns which of them a coefficient of a larger cube is, face · size² + y · size + x; none: a finer one.
// The coefficients of cubes of n texels a side are those of the first n × n of every face of a larger one,
// times size / n: the Haar basis is nested.
std::optional<uint16_t> bounceCoefficient(uint16_t coefficient, int size);
// Returns the coefficient of a cube of `size` texels a side that one of kBounceFaceSize is.
uint16_t coefficientOfBounce(uint16_t coefficient, int size);

// Returns what a layer's terms reflect of even light from all sides, per channel: at most 1 of a BRDF that
// makes no light, and its factors may exceed it.
vec3 reflectedShare(const FactoredBrdf& brdf, int layer);

// Returns what its view maps are multiplied by where it lights others: 1, or what brings a larger share down
// to 1, so that bounces die out.
vec3 sourceGain(vec3 reflectedShare);

// Returns those of the layers that `bound` binds, per part.
std::vector<std::vector<vec3>> sourceGains(const Asset& asset, const Appearance& bound);

class BounceGather {
  public:
    // Every part lights others as it looks in `bound`, times its sourceGain(). Refers to `asset`, of whose
    // transport it knows nothing. Throws Error when Embree fails.
    BounceGather(const Asset& asset, const Appearance& bound);

    // A layer that is held down.
    struct HeldLayer {
        size_t part;
        int layer;   // of the set that is bound
        float share; // what it would reflect, the largest of the channels
    };
    const std::vector<HeldLayer>& heldLayers() const { return mHeld; }

    // The report is told the number of vertices that are done, and returns whether to go on.
    using Report = std::function<bool(uint64_t vertices)>;

    // Returns rows per part and set, from those of the bound sets, per part, all of kBounceFaceSize. The same
    // whatever the threads; empty when stopped.
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
    std::vector<std::vector<vec3>> mGains;        // sourceGains()
    std::vector<std::vector<BoundLayer>> mLayers; // per part: what lights others
    std::vector<HeldLayer> mHeld;
    RayTracer mTracer; // one mesh per part
};

} // namespace relume
