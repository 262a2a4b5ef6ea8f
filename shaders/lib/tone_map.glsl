// Tone mapping of linear radiance to display values. C++ twin and sources: engine/render/tone_map.cpp.
#ifndef RELUME_SHADERS_LIB_TONE_MAP_GLSL
#define RELUME_SHADERS_LIB_TONE_MAP_GLSL
#include "shaders/shared/render.h"

vec3 aces(vec3 x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

// Returns log2 of normal floats to 3.1e-4: reading exponent and mantissa as one number is off by at most 0.09, which
// a polynomial of the mantissa corrects. log2() also handles denormal floats and NaN, in twice the time on lavapipe.
vec3 quickLog2(vec3 x) {
    const ivec3 bits = floatBitsToInt(x);
    const vec3 m = intBitsToFloat((bits & 0x7fffff) | 0x3f800000);
    const vec3 off = (m - 1) * (m - 2) * (-0.7650660 + m * (0.4059010 - 0.0816157 * m));
    return vec3(bits) * (1.0 / (1 << 23)) - 127 + off;
}

// Returns encodeSrgb(x^2.2), clamped, to 7e-5, by way of the square root.
vec3 encodeGamma(vec3 x) {
    x = clamp(x, 0, 1);
    const vec3 r = sqrt(x);
    const vec3 power = -0.0601005 + r * (0.0840359 + r * (1.1162638 + r * (-0.1789464 + r * 0.0387557)));
    const vec3 linear = x * x * (4.3086927 + 12.4238436 * r);
    return mix(power, linear, lessThan(x, vec3(0.0727213)));
}

// Returns display values.
vec3 agx(vec3 x) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                            0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    // Its inverse.
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                             1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                             1.15107367264116);
    const float lowest = -12.47393, highest = 4.026069;
    const vec3 stops = quickLog2(clamp(inset * x, exp2(lowest), exp2(highest)));
    const vec3 t = (stops - lowest) / (highest - lowest);
    const vec3 contrast =
        t * (t * (t * (t * (t * (15.5 * t - 40.14) + 31.96) - 6.868) + 0.4298) + 0.1191) - 0.00232;
    return encodeGamma(outset * contrast);
}

vec3 encodeSrgb(vec3 x) {
    return mix(1.055 * pow(x, vec3(1 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 toneMap(vec3 linear, uint curve, float scale) {
    // Comparisons with NaN are false.
    vec3 x = mix(vec3(0), min(linear * scale, vec3(1e15)), greaterThan(linear * scale, vec3(0)));
    if (curve == kToneAgx) return agx(x);
    if (curve == kToneAces) x = aces(x);
    return clamp(encodeSrgb(x), 0, 1);
}
#endif
