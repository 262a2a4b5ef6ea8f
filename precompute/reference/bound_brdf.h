// A bound layer as a function of two directions: the exact BRDF, or its K factored terms.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/brdf/material_brdfs.h"

namespace relume {

enum class ReferenceBrdf {
    Exact,
    Factored, // K terms
    Residual  // K terms, and what they leave without shadows: residual_estimate.h. Of images alone
};

class SeenBrdf;

// The BRDF itself; what a base color texture multiplies of it; or the rest.
class BoundBrdf {
  public:
    // Of the exact BRDF, from `brdfs`.
    BoundBrdf(const MaterialSet& set, const BoundLayer& layer, MaterialBrdfs& brdfs);
    // Of the factors, to which it refers.
    BoundBrdf(const MaterialSet& set, const BoundLayer& layer);

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
    // Per color channel, without the cosine, in sr⁻¹; of factors it can be negative. ωi.z > 0.
    vec3 evaluate(vec3 incoming) const;

  private:
    friend BoundBrdf;
    SeenBrdf(const BoundBrdf& bound, vec3 outgoing) : mBound(&bound), mOutgoing(outgoing) {}

    const BoundBrdf* mBound;
    vec3 mOutgoing;
    std::vector<vec3> mViews; // of factors: the view maps' values, one per term
};

} // namespace relume
