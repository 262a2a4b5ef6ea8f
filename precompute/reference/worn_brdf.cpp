#include "precompute/reference/worn_brdf.h"

#include <algorithm>

namespace relume {

namespace {

const AssetMaterial& materialOf(const MaterialSet& set, int layer) {
    return *std::ranges::find_if(set.materials, [&](const AssetMaterial& material) {
        return layer >= material.layer && layer < material.layer + material.layers();
    });
}

} // namespace

WornBrdf::WornBrdf(const MaterialSet& set, const WornLayer& layer, MaterialBrdfs& brdfs) {
    const AssetMaterial& material = materialOf(set, layer.layer);
    mExact = brdfs.of(material);
    mShare = layer.textured ? Share::Base : material.hasBase ? Share::WithoutBase : Share::Whole;
}

WornBrdf::WornBrdf(const MaterialSet& set, const WornLayer& layer)
    : mFactors(&set.brdf), mLayer(layer.layer) {}

SeenBrdf WornBrdf::seenFrom(vec3 outgoing) const {
    SeenBrdf seen(*this, outgoing);
    if (mExact) return seen;
    const MapPlace place = placeInMap(mFactors->size, mFactors->mapping, outgoing);
    for (int term = 0; term < mFactors->terms; term++)
        seen.mViews.push_back(lookupMap(mFactors->viewMap(mLayer, term), place));
    return seen;
}

vec3 SeenBrdf::evaluate(vec3 incoming) const {
    if (const Brdf* exact = mWorn->mExact.get()) switch (mWorn->mShare) {
        case WornBrdf::Share::Whole:
            return exact->evaluate(incoming, mOutgoing);
        case WornBrdf::Share::Base:
            return exact->evaluateBase(incoming, mOutgoing);
        case WornBrdf::Share::WithoutBase:
            return exact->evaluate(incoming, mOutgoing) - exact->evaluateBase(incoming, mOutgoing);
        }
    const FactoredBrdf& factors = *mWorn->mFactors;
    const MapPlace place = placeInMap(factors.size, factors.mapping, incoming);
    vec3 sum(0);
    for (int term = 0; term < factors.terms; term++)
        sum += mViews[size_t(term)] * lookupMap(factors.lightMap(term), place);
    return sum;
}

} // namespace relume
