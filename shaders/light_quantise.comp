#version 460
// Quantises the light's coefficients into a dense table and drops those below the threshold. One
// work-group: the maximum, then the sums that guard the range, then the values. All that decides a value is
// integer, or a float product that is exact or rounded once.
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

shared uint maxima[kGroup];
shared uvec3 sums[kGroup];

// Magnitudes are compared as the bits of their floats, which are in the same order.
const uint kLeastNormal = 0x00800000u;

uint largest(uvec3 v) { return max(v.r, max(v.g, v.b)); }

uvec3 magnitudesOf(uint index) {
    const uvec3 magnitudes = floatBitsToUint(coefficients[index]) & 0x7fffffffu;
    return magnitudes * uvec3(greaterThanEqual(magnitudes, uvec3(kLeastNormal)));
}

uint magnitudeOf(uint index) { return largest(magnitudesOf(index)); }

// The largest |component| of all coefficients.
uint groupMaximum(uint lane) {
    uint found = 0;
    for (uint i = lane; i < push.coefficients; i += kGroup) found = max(found, magnitudeOf(i));
    maxima[lane] = found;
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) maxima[lane] = max(maxima[lane], maxima[lane + step]);
        barrier();
    }
    return maxima[0];
}

// The exponent field of the smallest power of two of which `magnitude` is at most 32767: 14 below its own, or 13
// if its mantissa is above that of 32767, 0x7ffe00.
uint stepExponent(uint magnitude) { return max((magnitude + 0x1ffu) >> 23, 15u) - 14u; }

// |c| / step is a product with a power of two; its floor and the rest are exact. Halves away from zero.
uvec3 quantise(uint index, float inverse) {
    const vec3 places = uintBitsToFloat(magnitudesOf(index)) * inverse;
    const vec3 whole = floor(places);
    return uvec3(whole) + uvec3(greaterThanEqual(places - whole, vec3(0.5)));
}

float inverseOf(uint exponent) { return uintBitsToFloat((254u - exponent) << 23); }

// The largest channel's sum of magnitudes over the kept coefficients.
uint groupMagnitude(uint lane, uint least, float inverse) {
    uvec3 sum = uvec3(0);
    for (uint i = lane; i < push.coefficients; i += kGroup)
        if (magnitudeOf(i) >= least) sum += quantise(i, inverse);
    barrier(); // the sums of the step before have been read
    sums[lane] = sum;
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) sums[lane] += sums[lane + step];
        barrier();
    }
    return largest(sums[0]);
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint maximum = groupMaximum(lane);
    precise const float cut = uintBitsToFloat(maximum) * push.share;
    const uint least = max(floatBitsToUint(cut), kLeastNormal);
    uint exponent = stepExponent(maximum);
    while (groupMagnitude(lane, least, inverseOf(exponent)) > push.sumLimit) exponent++;
    for (uint i = lane; i < push.coefficients; i += kGroup) {
        ivec3 quantised = ivec3(0);
        if (magnitudeOf(i) >= least)
            quantised = ivec3(sign(coefficients[i])) * ivec3(quantise(i, inverseOf(exponent)));
        table[i] = packLight(quantised);
    }
    if (lane == 0) lightScale.scale = maximum > 0 ? uintBitsToFloat(exponent << 23) : 0;
}
