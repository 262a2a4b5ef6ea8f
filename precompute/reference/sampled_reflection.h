// The radiance that a point reflects, from a few shadow rays.
#pragma once

#include "engine/math/hashed_numbers.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"

namespace relume {

// An unbiased estimate of ∫ radiance · BRDF · cosine · visibility dω above the horizon of the point's frame,
// by resampled importance sampling (Talbot, Cline and Egbert, "Importance Resampling for Global
// Illumination", EGSR 2005). Candidates come from the light, the cosine and lobes about the mirror direction;
// each is weighed by what it adds where nothing blocks it, over the sum of all densities (Veach's balance
// heuristic); some are kept in proportion to that, and traced. Rays start `shadowOffset` along the point's
// normal.
vec3 sampleReflection(const SurfacePoint& point, const LightDistribution& light, const RayTracer& occluder,
                      float shadowOffset, HashedNumbers& random);

} // namespace relume
