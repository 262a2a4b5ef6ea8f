#version 460
// Separates the fill from the light: cuts every channel at kMostOfMean times the mean, over all texels, of their
// largest channels, in one work-group.
// C++ twin: fillOf() in engine/light/fill_light.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/light.h"

layout(local_size_x = kFillLanes) in;
layout(push_constant, scalar) uniform Push { LightFillPush push; };
layout(binding = 0, scalar) readonly buffer Radiance { vec3 radiance[]; };
layout(binding = 1, scalar) writeonly buffer Fill { vec3 fill[]; };

shared float sums[kFillLanes];

void main() {
    const uint lane = gl_LocalInvocationID.x;
    float sum = 0;
    for (uint i = lane; i < push.texels; i += kFillLanes)
        sum += max(max(radiance[i].r, radiance[i].g), max(radiance[i].b, 0));
    sums[lane] = sum;
    barrier();
    for (uint step = kFillLanes / 2; step > 0; step /= 2) {
        if (lane < step) sums[lane] += sums[lane + step];
        barrier();
    }
    const float most = sums[0] * push.share;
    for (uint i = lane; i < push.texels; i += kFillLanes) fill[i] = min(radiance[i], vec3(most));
}
