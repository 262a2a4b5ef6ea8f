// The estimates that are made of K terms and what they leave. GLSL twin: shaders/lib/unshadowed.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// The share of irradiance that reaches a point, by luminance, in [0, 1]; 1 of no light.
float litShare(vec3 irradiance, vec3 unshadowed);

// The sums that an estimate of a point and view is made of: the shadowed K terms (T), the unshadowed exact
// BRDF (E) and the unshadowed K terms (S).
struct ResidualSums {
    vec3 shadowed, exact, terms;
};

// Returns the estimate for signed terms: the control variate T + r (E - S), clamped to [r E / 4, E]; `share`
// is r.
// `isBounced`: T has light of other surfaces, too; the estimate may be above E by as much as T is above S.
vec3 differenceEstimate(const ResidualSums& sums, float share, bool isBounced = false);

// Returns the estimate for nonnegative terms: the ratio E T / S. Where all terms vanish in the view, the sums
// of the tuples give the ratio. Each channel's ratio is clamped to [0.8, 1.25] of the luminance's, and that
// to at least a quarter of the irradiance's: errors of storage would color and blacken what little light
// reaches. `isBounced`: ratios are free below 1, and what T has above S is added.
vec3 ratioEstimate(const ResidualSums& sums, vec3 tuples, vec3 unshadowedTuples, bool isBounced = false);

} // namespace relume
