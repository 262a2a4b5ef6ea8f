#version 460
// Computes the mean radiance of each texel of the lighting cube: a weighted sum over the pixels of its footprint in a
// prepared latlong map, turned by interpolating between columns. Several maps add up.
// C++ twin: sampleEnvironment() in engine/light/light_cube.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/texels.glsl"
#include "shaders/shared/render.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightSamplePush push; };
TEXELS(0, vec4, samplerBuffer, Environment, environment);
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
TEXELS(2, uvec2, usamplerBuffer, Pixels, pixels); // FootprintPixel
layout(binding = 3, scalar) buffer Radiance { vec3 radiance[]; };

void main() {
    const uint texel = gl_GlobalInvocationID.x;
    if (texel >= push.texels) return;
    vec3 sum = vec3(0);
    const uint end = starts[texel + 1];
    for (uint entry = starts[texel]; entry < end; entry++) {
        const uvec2 pixel = texelOf(pixels, int(entry)).xy; // place, weight
        const uint row = (pixel.x >> 16) * push.width;
        uint left = (pixel.x & 0xffff) + push.shift;
        if (left >= push.width) left -= push.width;
        const uint right = left + 1 < push.width ? left + 1 : 0;
        sum += uintBitsToFloat(pixel.y) * mix(texelOf(environment, int(row + left)).rgb,
                                              texelOf(environment, int(row + right)).rgb, push.fraction);
    }
    sum *= push.gain;
    if (push.isFirst == 0) sum += radiance[texel];
    radiance[texel] = sum;
}
