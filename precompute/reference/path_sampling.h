// Estimates the light that a point reflects: of lights, from a few shadow rays; of other surfaces, by tracing
// paths.
#pragma once

#include "engine/math/hashed_numbers.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"

#include <span>

namespace relume {

// Radiance that a point reflects, and what it would reflect if nothing cast shadows.
struct ReflectedRadiance {
    vec3 shadowed, unshadowed;
};

// Returns an unbiased estimate of ∫ radiance · BRDF · cosine · visibility dω above the horizon of the point's
// frame, by resampled importance sampling (Talbot, Cline and Egbert, "Importance Resampling for Global
// Illumination", EGSR 2005). Candidates come from the light, the cosine and lobes about the mirror direction,
// weighted by their unshadowed contribution over the sum of all densities (Veach's balance heuristic); a few,
// chosen in proportion to their weights, are traced. Rays are offset by `shadowOffset` along the point's
// normal. Both radiances are of the same candidates, so that their ratio has little noise.
ReflectedRadiance sampleReflection(const SurfacePoint& point, const LightDistribution& light,
                                   const RayTracer& occluder, float shadowOffset, HashedNumbers& random);

// The scene that paths traverse. Keeps references to all of it.
struct PathScene {
    const BoundAsset& asset;
    const RayTracer& surfaces; // of the asset's partMeshes()
    const RayTracer& occluder; // casts shadows
    std::span<const Mesh* const> meshes;
    const LightDistribution& light;
    float shadowOffset; // of ray origins along a point's normal
};

// Adds to byBounces[b] an unbiased estimate, from one path, of the radiance that reaches the eye after b + 1
// reflections before the one at `point`; direct light at the point is not included. Directions are drawn from
// the cosine and lobes about the mirror direction, weighted by the balance heuristic (Veach 1997); at every
// surface hit, light is sampled by sampleReflection(). Back faces are black.
void sampleBounces(const PathScene& scene, const SurfacePoint& point, std::span<vec3> byBounces,
                   HashedNumbers& random);

} // namespace relume
