// The unshadowed sums of single points under lights in a lighting cube, and the radiance that pixels estimate
// with them (residual_estimate.h).
#pragma once

#include "engine/scene/residual.h"
#include "precompute/error/baked_transport.h"
#include "precompute/reference/bound_asset.h"

namespace relume {

// The unshadowed sums of a point, seen from one direction.
struct UnshadowedLight {
    vec3 exact{0};           // radiance by the exact BRDF
    std::vector<vec3> tuple; // per term of the factors
};

// Returns the sums for each light, which is 6 F² texels row by row. `baked`: the point in the
// frame that the factors are of; `limit`: what limits it where a normal map gives another
// (BoundAsset::limitPointAt).
std::vector<UnshadowedLight> sumUnshadowed(const BakedTransport& transport, const SurfacePoint& point,
                                           const SurfacePoint& baked, const SurfacePoint& limit,
                                           const FactoredBrdf& factors,
                                           std::span<const std::span<const vec3>> lights);

// Returns the radiance of a pixel, as view_shade.frag computes it: the estimate of its residual, or without
// one the sum of the terms, clamped at zero. `views` has a value for each term that is summed: the view maps
// of the bound layers times their weights.
vec3 estimateRadiance(const ResidualSet* residual, std::span<const vec3> views, std::span<const vec3> tuple,
                      const UnshadowedLight& unshadowed);

} // namespace relume
