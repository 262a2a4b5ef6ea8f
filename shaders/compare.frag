#version 460
// Shows two linear images side by side, or a map of their difference. C++ twin of the map: heatColor() in
// engine/render/compare.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/render.h"

layout(push_constant, scalar) uniform Push { ComparePush push; };
layout(binding = 0) uniform sampler2DArray first; // both as large as the target
layout(binding = 1) uniform sampler2DArray second;

layout(location = 0) out vec4 color;

vec3 heatColor(float heat) {
    const float h = 4 * clamp(heat, 0, 1);
    vec3 c = mix(vec3(0), vec3(0.02, 0.03, 0.35), clamp(h, 0, 1));
    c = mix(c, vec3(0.5, 0.02, 0.25), clamp(h - 1, 0, 1));
    c = mix(c, vec3(1, 0.3, 0.01), clamp(h - 2, 0, 1));
    return mix(c, vec3(1, 1, 0.6), clamp(h - 3, 0, 1));
}

void main() {
    const ivec3 place = ivec3(gl_FragCoord.xy, 0);
    const vec4 a = texelFetch(first, place, 0), b = texelFetch(second, place, 0);
    if (push.mode == kCompareSplit) {
        color = gl_FragCoord.x < push.split ? a : b;
        return;
    }
    const vec3 apart = abs(a.rgb - b.rgb);
    color = vec4(heatColor(push.scale * (apart.r + apart.g + apart.b) / 3), max(a.a, b.a));
}
