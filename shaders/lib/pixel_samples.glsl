// Samples of a pixel in a multisampled visibility buffer, and which of them are shaded together. C++ twin:
// engine/render/pixel_samples.h.
#ifndef RELUME_SHADERS_LIB_PIXEL_SAMPLES_GLSL
#define RELUME_SHADERS_LIB_PIXEL_SAMPLES_GLSL
#include "shaders/shared/render.h"

layout(constant_id = 5) const uint kSamples = 4;
layout(binding = 0) uniform usampler2DMSArray triangleIds; // triangle ids; 0: none

// Reads the triangle ids of this fragment's pixel.
void readSamples(out uint seen[kSamples]) {
    for (int i = 0; i < kSamples; i++) seen[i] = texelFetch(triangleIds, ivec3(gl_FragCoord.xy, 0), i).x;
}

// Returns the position of a sample, in pixels from the pixel's upper left corner.
vec2 samplePosition(uint i) {
    // Mesa 22.3 compiles ?: wrongly here: the second component is wrong if all operands are constants.
    uvec2 places = uvec2(kSampleX8, kSampleY8);
    if (kSamples == 4) places = uvec2(kSampleX4, kSampleY4);
    if (kSamples == 2) places = uvec2(kSampleX2, kSampleY2);
    return vec2((places >> 4 * i) & 15) / 16;
}

// Returns whether two triangles share a vertex. In one mesh they then share its normal, and shading is continuous
// across them.
bool shareVertex(uvec3 a, uvec3 b) {
    return any(equal(a, b)) || any(equal(a, b.yzx)) || any(equal(a, b.zxy));
}

// Samples that are shaded once: for the triangle id of the first, at the mean of their positions.
struct SampleGroup {
    uint members; // a bit per sample
    vec2 position;
    float share; // share of the pixel's samples
};

// Makes the group of `members`, a bit per sample, which are not empty.
SampleGroup groupOf(uint members) {
    vec2 sum = vec2(0);
    for (uint i = 0; i < kSamples; i++) sum += float(members >> i & 1) * samplePosition(i);
    const float count = float(bitCount(members));
    return SampleGroup(members, sum / count, count / kSamples);
}
#endif
