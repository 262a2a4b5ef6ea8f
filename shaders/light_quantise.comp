#version 460
// Quantises the light's coefficients into a dense table and drops those below the threshold. One
// work-group: the maximum, then the sums that guard the range, then the values.
// C++ twin: makeLightVector() in engine/light/light_vector.h, where the steps are numbered.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_packing.glsl"
#include "shaders/shared/render.h"

const uint kGroup = 128;
layout(local_size_x = kGroup) in;
layout(push_constant, scalar) uniform Push { LightQuantisePush push; };
layout(binding = 0, scalar) readonly buffer Coefficients { vec3 coefficients[]; };
layout(binding = 1, scalar) writeonly buffer Table { PackedLight table[]; };
layout(binding = 2, scalar) writeonly buffer Scale { LightScale lightScale; };

shared float maxima[kGroup];
shared uvec3 sums[kGroup];

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }
uint largest(uvec3 v) { return max(v.r, max(v.g, v.b)); }

// Rounds to nearest, halves away from zero.
ivec3 quantise(vec3 coefficient, float maximum, uint steps) {
    precise const vec3 place = abs(coefficient) / maximum * float(steps) + 0.5;
    return ivec3(sign(coefficient) * floor(place));
}

bool isKept(ivec3 quantised) { return largest(uvec3(abs(quantised))) >= push.threshold; }

// The largest |component| of all coefficients.
float groupMaximum(uint lane) {
    maxima[lane] = 0;
    for (uint i = lane; i < push.coefficients; i += kGroup)
        maxima[lane] = max(maxima[lane], largest(abs(coefficients[i])));
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) maxima[lane] = max(maxima[lane], maxima[lane + step]);
        barrier();
    }
    return maxima[0];
}

// The largest channel's sum of magnitudes over the kept coefficients.
uint groupMagnitude(uint lane, float maximum) {
    uvec3 sum = uvec3(0);
    for (uint i = lane; i < push.coefficients; i += kGroup) {
        const ivec3 quantised = quantise(coefficients[i], maximum, push.maximum);
        if (isKept(quantised)) sum += uvec3(abs(quantised));
    }
    sums[lane] = sum;
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) sums[lane] += sums[lane + step];
        barrier();
    }
    return largest(sums[0]);
}

// lightMaximumFor() of the twin.
uint stepsFor(uint magnitude) {
    if (magnitude <= push.sumLimit) return push.maximum;
    const uint coarsening = (magnitude + push.entryLimit + push.maximum - 1) / push.maximum;
    return (push.sumLimit - push.entryLimit) / coarsening;
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const float maximum = groupMaximum(lane);
    const uint steps = maximum > 0 ? stepsFor(groupMagnitude(lane, maximum)) : push.maximum;
    for (uint i = lane; i < push.coefficients; i += kGroup) {
        ivec3 quantised = ivec3(0);
        if (maximum > 0 && isKept(quantise(coefficients[i], maximum, push.maximum)))
            quantised = quantise(coefficients[i], maximum, steps);
        table[i] = packLight(quantised);
    }
    if (lane == 0) lightScale.scale = maximum / float(steps);
}
