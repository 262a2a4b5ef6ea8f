#version 460
// Adds lamps to the lighting cube. C++ twin: addLamp() in engine/light/lamp.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_cap.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightCapsPush push; };
layout(binding = 0, scalar) readonly buffer Lamps { LightCap lamps[]; };
layout(binding = 1, scalar) readonly buffer Gains { float gains[]; };
layout(binding = 2, scalar) buffer Radiance { vec3 radiance[]; };

void main() {
    const uint index = gl_GlobalInvocationID.x, face = index >> (2 * push.sideBits);
    if (face >= 6) return;
    const CapTexel texel = capTexel(index, push.sideBits);
    vec3 sum = radiance[index];
    for (uint lamp = push.first; lamp < push.first + push.count; lamp++) {
        const float covered = capCoverage(texel, lamps[lamp].centers[face], lamps[lamp].inner, lamps[lamp].outer,
                                          lamps[lamp].side);
        if (covered > 0) sum += covered * gains[lamp] * lamps[lamp].radiance;
    }
    radiance[index] = sum;
}
