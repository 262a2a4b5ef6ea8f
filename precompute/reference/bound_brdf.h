// A bound layer as a function of two directions: the exact BRDF, or its K factored terms.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/brdf/material_brdfs.h"

namespace relume {

enum class ReferenceBrdf {
    Exact,
    Factored, // the K terms
    Residual  // the K terms with the residual (residual_estimate.h); for images only
};

class SeenBrdf;

// The BRDF of a layer: the whole, the part that a base color texture multiplies, or the rest.
class BoundBrdf {
  public:
    // Uses the exact BRDF, made by `brdfs`.
    BoundBrdf(const MaterialSet& set, const BoundLayer& layer, MaterialBrdfs& brdfs);
    // Uses the factors; keeps a reference to `set`.
    BoundBrdf(const MaterialSet& set, const BoundLayer& layer);

    // Returns the BRDF for a view direction in the local frame, above the horizon. Keeps a reference to this
    // object.
    SeenBrdf seenFrom(vec3 outgoing) const;

  private:
    friend SeenBrdf;
    enum class Share { Whole, Base, WithoutBase };

    std::shared_ptr<const Brdf> mExact; // null: factored
    Share mShare = Share::Whole;
    const FactoredBrdf* mFactors = nullptr;
    int mLayer = 0; // of the view maps
};

// f(ωi, ωo) for a fixed ωo, since a pixel needs many ωi.
class SeenBrdf {
  public:
    // Returns f per color channel, without the cosine, in sr⁻¹, for ωi.z > 0. With factors it can be
    // negative.
    vec3 evaluate(vec3 incoming) const;

  private:
    friend BoundBrdf;
    SeenBrdf(const BoundBrdf& bound, vec3 outgoing) : mBound(&bound), mOutgoing(outgoing) {}

    const BoundBrdf* mBound;
    vec3 mOutgoing;
    std::vector<vec3> mViews; // of factors: values of the view maps, one per term
};

} // namespace relume
