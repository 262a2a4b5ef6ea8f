#version 460
// Paints strokes over the lighting cube, one after the other. C++ twin: paintStroke() in engine/light/stroke.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_cap.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightCapsPush push; };
layout(binding = 0, scalar) readonly buffer Strokes { LightCap strokes[]; };
layout(binding = 1, scalar) buffer Radiance { vec3 radiance[]; };

void main() {
    const uint index = gl_GlobalInvocationID.x, face = index >> (2 * push.sideBits);
    if (face >= 6) return;
    const CapTexel texel = capTexel(index, push.sideBits);
    vec3 painted = radiance[index];
    for (uint stroke = push.first; stroke < push.first + push.count; stroke++) {
        const float covered = capCoverage(texel, strokes[stroke].centers[face], strokes[stroke].inner,
                                          strokes[stroke].outer, strokes[stroke].side);
        if (covered > 0) painted = mix(painted, strokes[stroke].radiance, covered * strokes[stroke].amount);
    }
    radiance[index] = painted;
}
