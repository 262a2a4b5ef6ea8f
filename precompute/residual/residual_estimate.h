// The estimates that combine K terms with the residual. GLSL twin: shaders/lib/unshadowed.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// Returns the share of irradiance that reaches a point, by luminance, in [0, 1]; 1 if there is no light.
float litShare(vec3 irradiance, vec3 unshadowed);

// The sums for a point and view: the shadowed K terms (T), the unshadowed exact BRDF (E) and the unshadowed K
// terms (S).
struct ResidualSums {
    vec3 shadowed, exact, terms;
};

// Returns the estimate for signed terms, the control variate T + r (E - S), clamped to [r E / 4, E]; `share`
// is r. With `isBounced`, T includes light from other surfaces, and the estimate may exceed E by as much as T
// exceeds S.
vec3 differenceEstimate(const ResidualSums& sums, float share, bool isBounced = false);

// Returns the estimate for nonnegative terms, the ratio E T / S. If all terms vanish in the view, sums of the
// tuples give the ratio. Each channel's ratio is clamped to [0.8, 1.25] of the luminance's and to at most 1,
// the luminance's to at least a quarter of the irradiance's, since storage errors would otherwise color and
// darken faint light. With `isBounced`, ratios are only clamped to [0, 1], and the excess of T over S is
// added.
vec3 ratioEstimate(const ResidualSums& sums, vec3 tuples, vec3 unshadowedTuples, bool isBounced = false);

} // namespace relume
