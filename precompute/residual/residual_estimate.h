// The estimates that combine K terms with the residual. GLSL twin: shaders/lib/unshadowed.glsl.
#pragma once

#include "engine/math/vector.h"

#include <span>

namespace relume {

// Returns the share of irradiance that reaches a point, by luminance, in [0, 1]; 1 if there is no light.
float litShare(vec3 irradiance, vec3 unshadowed);

// The sums of a light for a point and view: the shadowed K terms (T), the unshadowed exact BRDF (E) and the
// unshadowed K terms (S); and tuples without a view, shadowed and not: weighted so that they sum to
// irradiance where terms are signed, added up where they are not. `direct` (D) and `directLit` are the direct
// light in `shadowed` and `lit`, the same as these unless light bounces.
struct EstimateSums {
    vec3 shadowed{0}, exact{0}, terms{0};
    vec3 lit{0}, unlit{0};
    vec3 direct{0}, directLit{0};
};

// Returns the sums of the key. Its E is `exact`, or 0 where the tuples see nothing of the key.
EstimateSums keyOf(const EstimateSums& whole, const EstimateSums& fill, vec3 exact);

// Returns what ratios add to every view map under the key: the mean of `views`, and shared::kLeastView.
vec3 keyLeastView(std::span<const vec3> views);

// Returns the estimate for signed terms, the control variate T + r (E - S), clamped to [r E / 4, E], where r
// is the lit share of the irradiance. With `isBounced`, T includes light from other surfaces, and the
// estimate may exceed E by as much as T exceeds S.
vec3 differenceEstimate(const EstimateSums& sums, bool isBounced = false);

// Returns the estimate for nonnegative terms, the ratio E D / S, where D / S is at most 1; with `isBounced`
// the rest of T is added, and what D exceeds S by. `leastView` is added to every view map: the more, the more
// the sums of the tuples give the ratio.
vec3 ratioEstimate(const EstimateSums& sums, vec3 leastView, bool isBounced = false);

} // namespace relume
