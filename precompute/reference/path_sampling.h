// The radiance that a point reflects of light that other surfaces send it, by tracing paths.
#pragma once

#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"
#include "precompute/reference/sampled_reflection.h"

#include <span>

namespace relume {

// What paths meet. Refers to all of it.
struct PathScene {
    const BoundAsset& asset;
    const RayTracer& surfaces; // of the asset's partMeshes()
    const RayTracer& occluder; // what casts shadows
    std::span<const Mesh* const> meshes;
    const LightDistribution& light;
    float shadowOffset; // that rays start along a point's normal
};

// Adds an unbiased estimate, from one path, of what reaches the eye after b + 1 reflections on the way to the
// point to byBounces[b]; what the point reflects of the light itself is not part of it. Directions are drawn
// from the cosine and lobes about the mirror direction, weighed by the balance heuristic (Veach 1997); at
// every surface met the light is sampled (sampleReflection). Surfaces are black from behind.
void sampleBounces(const PathScene& scene, const SurfacePoint& point, std::span<vec3> byBounces,
                   HashedNumbers& random);

} // namespace relume
