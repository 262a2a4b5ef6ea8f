#include "precompute/reference/bound_brdf.h"

#include <algorithm>

namespace relume {

namespace {

const AssetMaterial& materialOf(const MaterialSet& set, int layer) {
    return *std::ranges::find_if(set.materials, [&](const AssetMaterial& material) {
        return layer >= material.layer && layer < material.layer + material.layers();
    });
}

} // namespace

BoundBrdf::BoundBrdf(const MaterialSet& set, const BoundLayer& layer, MaterialBrdfs& brdfs) {
    const AssetMaterial& material = materialOf(set, layer.layer);
    mExact = brdfs.of(material);
    mShare = layer.textured ? Share::Base : material.hasBase ? Share::WithoutBase : Share::Whole;
}

BoundBrdf::BoundBrdf(const MaterialSet& set, const BoundLayer& layer)
    : mFactors(&set.brdf), mLayer(layer.layer) {}

SeenBrdf BoundBrdf::seenFrom(vec3 outgoing) const {
    SeenBrdf seen(*this, outgoing);
    if (mExact) return seen;
    const MapPlace place = placeInMap(mFactors->size, mFactors->mapping, outgoing);
    for (int term = 0; term < mFactors->terms; term++)
        seen.mViews.push_back(lookupMap(mFactors->viewMap(mLayer, term), place));
    return seen;
}

vec3 SeenBrdf::evaluate(vec3 incoming) const {
    if (const Brdf* exact = mBound->mExact.get()) switch (mBound->mShare) {
        case BoundBrdf::Share::Whole:
            return exact->evaluate(incoming, mOutgoing);
        case BoundBrdf::Share::Base:
            return exact->evaluateBase(incoming, mOutgoing);
        case BoundBrdf::Share::WithoutBase:
            return exact->evaluate(incoming, mOutgoing) - exact->evaluateBase(incoming, mOutgoing);
        }
    const FactoredBrdf& factors = *mBound->mFactors;
    const MapPlace place = placeInMap(factors.size, factors.mapping, incoming);
    vec3 sum(0);
    for (int term = 0; term < factors.terms; term++)
        sum += mViews[size_t(term)] * lookupMap(factors.lightMap(term), place);
    return sum;
}

} // namespace relume
