#version 460
// Adds distant lights to the lighting cube. Each texel occurs in one tap at most, so that invocations do not collide.
// C++ twin: addDistantLights() in engine/light/distant_light.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/light.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightDistantPush push; };
layout(binding = 0, scalar) readonly buffer Taps { LightTap taps[]; };
layout(binding = 1, scalar) buffer Radiance { vec3 radiance[]; };

void main() {
    const uint tap = gl_GlobalInvocationID.x;
    if (tap < push.taps) radiance[taps[tap].texel] += taps[tap].radiance;
}
