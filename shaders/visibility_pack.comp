#version 460
// Packs visibility to one bit per texel: whether it is free and above the point's horizon. Bit i of a word is texel i
// of its 32, row by row.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/horizon.glsl"
#include "shaders/shared/bake.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kSize = 256;
layout(push_constant, scalar) uniform Push { PackVisibilityPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, std430) readonly buffer Blocked { uvec4 blocked[]; }; // bytes, 0 or 1
layout(binding = 2, std430) writeonly buffer Visible { uint visible[]; };

// Moves bit 8i of `bytes` to bit i.
uint gather(uint bytes) { return (bytes * 0x01020408u) >> 24 & 0xfu; }
uint gather(uvec4 bytes) {
    return gather(bytes.x) | gather(bytes.y) << 4 | gather(bytes.z) << 8 | gather(bytes.w) << 12;
}

void main() {
    const uint word = gl_GlobalInvocationID.x;
    if (word >= push.words) return;
    const uint texel = word * 32;
    const uint layer = texel / (kSize * kSize);
    const uint y = texel / kSize % kSize, x = texel % kSize;

    const uint above = aboveHorizon(points[layer / 6].normal * kFaceAxes[layer % 6], x, y, kSize);
    uint free = 0;
    if (above != 0) free = ~(gather(blocked[2 * word]) | gather(blocked[2 * word + 1]) << 16);
    visible[word] = free & above;
}
