// The estimates that are made of K terms and what they leave. GLSL twin: shaders/lib/unshadowed.glsl.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// The share of irradiance that reaches a point, by luminance, in [0, 1]; 1 of no light.
float litShare(vec3 irradiance, vec3 unshadowed);

// Of a point and view: by K terms and shadows (T), by the exact BRDF without shadows (E), by K terms without
// (S).
struct ResidualSums {
    vec3 shadowed, exact, terms;
};

// Of terms that can be negative: the control variate T + r (E - S), between r E / 4 and E. `share`: r.
vec3 differenceEstimate(const ResidualSums& sums, float share);

// Of terms that cannot: the ratio E T / S. Where no term sees anything, the shares of the tuples' sums
// decide.
vec3 ratioEstimate(const ResidualSums& sums, vec3 tuples, vec3 unshadowedTuples);

} // namespace relume
