// A layer that a part wears, as a function: of the exact BRDF, or of its K factored terms.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/brdf/material_brdfs.h"

namespace relume {

enum class ReferenceBrdf {
    Exact,
    Factored, // K terms
    Residual  // K terms, and what they leave without shadows: residual_twin.h. Of images alone
};

class SeenBrdf;

// The BRDF itself; what a base colour texture multiplies of it; or the rest.
class WornBrdf {
  public:
    // Of the exact BRDF, from `brdfs`.
    WornBrdf(const MaterialSet& set, const WornLayer& layer, MaterialBrdfs& brdfs);
    // Of the factors, to which it refers.
    WornBrdf(const MaterialSet& set, const WornLayer& layer);

    // At a view direction in the local frame, above the horizon. Refers to this.
    SeenBrdf seenFrom(vec3 outgoing) const;

  private:
    friend SeenBrdf;
    enum class Share { Whole, Base, WithoutBase };

    std::shared_ptr<const Brdf> mExact; // none: factored
    Share mShare = Share::Whole;
    const FactoredBrdf* mFactors = nullptr;
    int mLayer = 0; // of view maps
};

// f(ωi, ωo) of one ωo: a pixel asks for many ωi.
class SeenBrdf {
  public:
    // Per colour channel, without the cosine, in sr⁻¹; of factors it can be negative. ωi.z > 0.
    vec3 evaluate(vec3 incoming) const;

  private:
    friend WornBrdf;
    SeenBrdf(const WornBrdf& worn, vec3 outgoing) : mWorn(&worn), mOutgoing(outgoing) {}

    const WornBrdf* mWorn;
    vec3 mOutgoing;
    std::vector<vec3> mViews; // of factors: the view maps' values, one per term
};

} // namespace relume
