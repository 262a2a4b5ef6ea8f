#version 460
// Computes the factor on each lamp's coverage that makes its solid angle exact: a work-group per lamp.
// C++ twin: addLamp() in engine/light/lamp.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_cap.glsl"

const uint kGroup = 128;
layout(local_size_x = kGroup) in;
layout(push_constant, scalar) uniform Push { LightCapsPush push; };
layout(binding = 0, scalar) readonly buffer Lamps { LightCap lamps[]; };
layout(binding = 1, scalar) writeonly buffer Gains { float gains[]; };

shared float sums[kGroup];

void main() {
    const uint lane = gl_LocalInvocationID.x, lamp = gl_WorkGroupID.y;
    const float inner = lamps[lamp].inner, outer = lamps[lamp].outer;
    const uint side = lamps[lamp].side, texels = 1u << (2 * push.sideBits);
    float sum = 0;
    for (uint face = 0; face < 6; face++) {
        const vec3 center = lamps[lamp].centers[face];
        for (uint place = lane; place < texels; place += kGroup) {
            const CapTexel texel = capTexel(place, push.sideBits);
            sum += capCoverage(texel, center, inner, outer, side) * cubeSolidAngle(middleOf(texel), texel.width);
        }
    }
    sums[lane] = sum;
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) sums[lane] += sums[lane + step];
        barrier();
    }
    if (lane == 0) gains[lamp] = lamps[lamp].amount / sums[0];
}
