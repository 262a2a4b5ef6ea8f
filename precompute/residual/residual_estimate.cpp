#include "precompute/residual/residual_estimate.h"

#include "engine/math/color.h"
#include "shaders/shared/render.h"

#include <algorithm>

namespace relume {

namespace {

constexpr float kLeastShare = 0.25f; // least estimate, relative to r E

} // namespace

float litShare(vec3 irradiance, vec3 unshadowed) {
    const float all = luminance(unshadowed);
    return all > 0 ? std::clamp(luminance(irradiance) / all, 0.0f, 1.0f) : 1;
}

EstimateSums keyOf(const EstimateSums& whole, const EstimateSums& fill, vec3 exact) {
    const vec3 unlit = whole.unlit - fill.unlit;
    return {whole.shadowed - fill.shadowed,
            luminance(unlit) > 0 ? exact : vec3(0),
            whole.terms - fill.terms,
            whole.lit - fill.lit,
            unlit,
            whole.direct - fill.direct,
            whole.directLit - fill.directLit};
}

vec3 keyLeastView(std::span<const vec3> views) {
    vec3 sum(0);
    for (const vec3& view : views) sum += view;
    return shared::kLeastView + sum / float(views.size());
}

vec3 differenceEstimate(const EstimateSums& sums, bool isBounced) {
    const float share = litShare(sums.lit, sums.unlit);
    const vec3 above = isBounced ? glm::max(sums.shadowed - sums.terms, vec3(0)) : vec3(0);
    return glm::clamp(sums.shadowed + share * (sums.exact - sums.terms), kLeastShare * share * sums.exact,
                      sums.exact + above);
}

vec3 ratioEstimate(const EstimateSums& sums, vec3 leastView, bool isBounced) {
    const vec3 all = sums.terms + leastView * sums.unlit, lit = sums.direct + leastView * sums.directLit;
    const vec3 estimate = sums.exact * glm::clamp(lit / glm::max(all, vec3(1e-30)), vec3(0), vec3(1));
    if (!isBounced) return estimate;
    // Quantized tuples can be negative, radiance cannot.
    return estimate + glm::max(sums.shadowed - sums.direct, vec3(0)) +
           glm::max(sums.direct - sums.terms, vec3(0));
}

} // namespace relume
