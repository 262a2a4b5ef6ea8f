#version 460
// Adds the day sky, without the sun's disc, to the lighting cube.
// C++ twin: addSky() in engine/light/day_sky.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/sky.glsl"
#include "shaders/shared/light.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightSky sky; };
layout(binding = 0, scalar) buffer Radiance { vec3 radiance[]; };

const uint kCells = 2; // along a texel's side

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
        sum += weight * skyRadiance(sky, normalize(cubeDirection(face, uv)));
        weights += weight;
    }
    radiance[index] += sum / weights;
}
