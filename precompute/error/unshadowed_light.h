// Unshadowed radiance at single points under lighting cubes, and the radiance that pixels estimate with it
// (residual_estimate.h).
#pragma once

#include "engine/scene/residual.h"
#include "precompute/error/baked_transport.h"
#include "precompute/reference/bound_asset.h"

namespace relume {

// Unshadowed sums at a point, seen from one direction.
struct UnshadowedLight {
    vec3 exact{0};           // radiance with the exact BRDF
    vec3 most{0};            // what limits it at a mapped normal; elsewhere the same
    std::vector<vec3> tuple; // per term of the factors
};

// Returns the sums for each light of 6 F² texels in row order. `baked` is the point in the frame of its
// factors; `limit` is what limits it where a normal map gives another frame (BoundAsset::limitPointAt).
std::vector<UnshadowedLight> sumUnshadowed(const BakedTransport& transport, const SurfacePoint& point,
                                           const SurfacePoint& baked, const SurfacePoint& limit,
                                           const FactoredBrdf& factors,
                                           std::span<const std::span<const vec3>> lights);

// A point's tuple under a light, the direct light in it, and unshadowed sums.
struct PointLight {
    std::span<const vec3> tuple, direct;
    const UnshadowedLight& unshadowed;
};

// Returns the radiance of a pixel, as view_shade.frag computes it: with the estimates of `residual` for the
// fill and for the rest of the light, or, if it is null, the sum of the whole light's terms clamped at zero.
// `views` has a value per term that is summed: the view maps of the bound layers times their weights.
vec3 estimateRadiance(const ResidualSet* residual, std::span<const vec3> views, const PointLight& whole,
                      const PointLight& fill);

} // namespace relume
