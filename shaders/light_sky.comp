#version 460
// Adds the day sky to the lighting cube, without the sun's disc.
// C++ twin: addSky() and skyRadiance() in engine/light/day_sky.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/light.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightSky sky; };
layout(binding = 0, scalar) buffer Radiance { vec3 radiance[]; };

const uint kCells = 2; // of a texel's side

vec3 rgbOf(vec3 Yxy) {
    const vec3 XYZ = vec3(Yxy.y, Yxy.z, 1 - Yxy.y - Yxy.z) * (Yxy.x / Yxy.z);
    return max(vec3(dot(XYZ, vec3(3.2406, -1.5372, -0.4986)), dot(XYZ, vec3(-0.9689, 1.8758, 0.0415)),
                    dot(XYZ, vec3(0.0557, -0.2040, 1.0570))),
               vec3(0));
}

vec3 skyRadiance(vec3 direction) {
    if (direction.y <= 0) return sky.ground;
    // By the half chord: acos would lose digits near the sun.
    const float toSun = 2 * asin(min(0.5 * distance(direction, sky.sun), 1));
    const float cosine = dot(direction, sky.sun);
    const vec3 distribution = (1 + sky.a * exp(sky.b / direction.y)) *
                              (1 + sky.c * exp(sky.d * toSun) + sky.e * cosine * cosine);
    return rgbOf(sky.zenith * distribution);
}

void main() {
    const uint index = gl_GlobalInvocationID.x, mask = (1u << sky.sideBits) - 1;
    const uint face = index >> (2 * sky.sideBits);
    if (face >= 6) return;
    const vec2 place = vec2(index & mask, (index >> sky.sideBits) & mask);
    vec3 sum = vec3(0);
    float weights = 0;
    for (uint cell = 0; cell < kCells * kCells; cell++) {
        const vec2 within = (vec2(cell % kCells, cell / kCells) + 0.5) / float(kCells);
        const vec2 uv = 2 * (place + within) / float(1u << sky.sideBits) - 1;
        const float weight = cubeSolidAngle(uv, 1);
        sum += weight * skyRadiance(normalize(cubeDirection(face, uv)));
        weights += weight;
    }
    radiance[index] += sum / weights;
}
