#version 460
// Keeps the pixels that are shaded more than once, so that the stencil marks them: those with a sample that is not
// shaded together with the first, or that differs from it in coverage.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/pixel_samples.glsl"
#include "shaders/lib/texels.glsl"

layout(push_constant, scalar) uniform Push { ViewEdgesPush push; };
TEXELS(1, uvec4, usamplerBuffer, Triangles, triangles); // of the part: three corners, fourth component unused

bool isOfPart(uint triangleId) { return triangleId - push.firstTriangleId < push.triangleCount; }

uvec3 cornersOf(uint triangleId) {
    return texelOf(triangles, int(min(triangleId - push.firstTriangleId, push.triangleCount - 1))).xyz;
}

void main() {
    uint seen[kSamples];
    readSamples(seen);
    // The stencil rejects most pixels of other parts before the shader runs.
    if (seen[0] != 0 && !isOfPart(seen[0])) discard;
    const uvec3 first = cornersOf(seen[0]);
    bool isEdge = false;
    for (uint i = 1; i < kSamples; i++) {
        const bool isOne = isOfPart(seen[0]) && isOfPart(seen[i]) && shareVertex(first, cornersOf(seen[i]));
        isEdge = isEdge || (seen[i] != seen[0] && !isOne);
    }
    if (!isEdge) discard;
}
