// Estimates the radiance that a point reflects from a few shadow rays.
#pragma once

#include "engine/math/hashed_numbers.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"

namespace relume {

// Returns an unbiased estimate of ∫ radiance · BRDF · cosine · visibility dω above the horizon of the point's
// frame, by resampled importance sampling (Talbot, Cline and Egbert, "Importance Resampling for Global
// Illumination", EGSR 2005). Candidates come from the light, the cosine and lobes about the mirror direction,
// weighted by their unshadowed contribution over the sum of all densities (Veach's balance heuristic); a few,
// chosen in proportion to their weights, are traced. Rays are offset by `shadowOffset` along the point's
// normal.
vec3 sampleReflection(const SurfacePoint& point, const LightDistribution& light, const RayTracer& occluder,
                      float shadowOffset, HashedNumbers& random);

} // namespace relume
