// From linear radiance to display values. C++ twin and sources: engine/render/tone_map.cpp.
#ifndef RELUME_SHADERS_LIB_TONE_MAP_GLSL
#define RELUME_SHADERS_LIB_TONE_MAP_GLSL
#include "shaders/shared/render.h"

vec3 aces(vec3 x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

vec3 agx(vec3 x) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                            0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    // Its inverse.
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                             1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                             1.15107367264116);
    const float lowest = -12.47393, highest = 4.026069;
    const vec3 t = clamp((log2(max(inset * x, vec3(1e-10))) - lowest) / (highest - lowest), 0, 1);
    const vec3 t2 = t * t, t4 = t2 * t2;
    const vec3 contrast =
        15.5 * t4 * t2 - 40.14 * t4 * t + 31.96 * t4 - 6.868 * t2 * t + 0.4298 * t2 + 0.1191 * t - 0.00232;
    return pow(max(outset * contrast, vec3(0)), vec3(2.2));
}

vec3 encodeSrgb(vec3 x) {
    return mix(1.055 * pow(x, vec3(1 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 toneMap(vec3 linear, uint curve, float scale) {
    // A comparison with what is no number is false.
    vec3 x = mix(vec3(0), min(linear * scale, vec3(1e15)), greaterThan(linear * scale, vec3(0)));
    if (curve == kToneAces) x = aces(x);
    if (curve == kToneAgx) x = agx(x);
    return clamp(encodeSrgb(x), 0, 1);
}
#endif
