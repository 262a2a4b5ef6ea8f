// Estimates, by tracing paths, the light of other surfaces that a point reflects.
#pragma once

#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"
#include "precompute/reference/sampled_reflection.h"

#include <span>

namespace relume {

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
