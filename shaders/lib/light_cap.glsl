// Coverage of a texel by a cap. C++ twin: capCoverage() in engine/light/cap.h.
#ifndef RELUME_LIB_LIGHT_CAP_GLSL
#define RELUME_LIB_LIGHT_CAP_GLSL
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/light.h"

struct CapTexel {
    vec2 low; // u and v of its upper left corner
    float width; // in u and v
};

CapTexel capTexel(uint place, uint sideBits) {
    const float width = 2.0 / float(1u << sideBits);
    const uint mask = (1u << sideBits) - 1;
    return CapTexel(vec2(place & mask, (place >> sideBits) & mask) * width - 1, width);
}

vec2 middleOf(CapTexel texel) { return texel.low + 0.5 * texel.width; }

// Returns the share of a texel that a cap covers. `center` is in the frame of its face; the rest is as in LightCap.
float capCoverage(CapTexel texel, vec3 center, float inner, float outer, uint side) {
    // No point of a texel is further from its center than this: projection to the sphere brings points together.
    const float reach = 0.5 * sqrt(2.0) * texel.width;
    const float away = distance(normalize(vec3(middleOf(texel), 1)), center);
    if (away - reach >= outer) return 0;
    if (away + reach <= inner) return 1;
    const float cell = texel.width / float(side);
    float covered = 0, weights = 0;
    for (uint j = 0; j < side; j++)
        for (uint i = 0; i < side; i++) {
            const vec2 uv = texel.low + (vec2(i, j) + 0.5) * cell;
            const float squared = 1 + dot(uv, uv), root = sqrt(squared);
            const float weight = 1 / (squared * root);
            covered += weight * clamp((outer - distance(vec3(uv, 1) / root, center)) / (outer - inner), 0, 1);
            weights += weight;
        }
    return covered / weights;
}

#endif
