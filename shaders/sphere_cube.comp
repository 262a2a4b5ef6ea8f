#version 460
// Downsamples the lighting cube to faces of kSphereCube² texels, each with a border from its neighbors so that
// bilinear lookups have no seam, and makes one light of every coarse cell, at the centroid of its radiance: for the
// fill, at that of the whole light.
// C++ twin: sphereCube() and cellLights() in precompute/twins/lit_sphere_twin.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SphereCubePush push; };
layout(binding = 0, scalar) readonly buffer Radiance { vec3 radiance[]; };
layout(binding = 1, std430) writeonly buffer Texels { vec4 texels[]; };
layout(binding = 2, std430) writeonly buffer Lights { vec4 lights[]; }; // kCellTexels each

// Returns the mean radiance of a texel, of kSphereCube a side.
vec3 meanOf(uint face, uvec2 texel) {
    const uint side = push.faceSize / kSphereCube;
    vec3 sum = vec3(0);
    for (uint y = 0; y < side; y++)
        for (uint x = 0; x < side; x++)
            sum += radiance[(face * push.faceSize + texel.y * side + y) * push.faceSize + texel.x * side + x];
    return sum / float(side * side);
}

void writeTexel(uint item) {
    const uint face = item / (kSphereCubeBordered * kSphereCubeBordered);
    const ivec2 place = ivec2(item % kSphereCubeBordered, item / kSphereCubeBordered % kSphereCubeBordered) - 1;
    const vec3 direction = cubeDirection(face, (vec2(place) + 0.5) * (2.0 / kSphereCube) - 1);
    const uint seen = cubeFace(direction);
    const vec2 uv = cubeCoordinates(seen, direction);
    const uvec2 texel = uvec2(clamp(ivec2((uv + 1) * (0.5 * kSphereCube)), ivec2(0), ivec2(kSphereCube - 1)));
    texels[item] = vec4(meanOf(seen, texel), 0);
}

void writeLight(uint item) {
    const uint face = item / (kTupleCells * kTupleCells);
    const uvec2 cell = uvec2(item % kTupleCells, item / kTupleCells % kTupleCells);
    const uint side = push.faceSize / kTupleCells;
    vec3 energy = vec3(0), weighted = vec3(0);
    for (uint y = 0; y < side; y++)
        for (uint x = 0; x < side; x++) {
            const uvec2 texel = cell * side + uvec2(x, y);
            const vec2 uv = (vec2(texel) + 0.5) * (2.0 / float(push.faceSize)) - 1;
            const vec3 emitted = radiance[(face * push.faceSize + texel.y) * push.faceSize + texel.x] *
                                 cubeSolidAngle(uv, 2.0 / float(push.faceSize));
            energy += emitted;
            weighted += dot(abs(emitted), vec3(1)) * normalize(cubeDirection(face, uv));
        }
    if (push.isFill != 0) {
        lights[kCellTexels * item + 2] = vec4(energy, 0);
        return;
    }
    const vec3 middle = cubeDirection(face, (vec2(cell) + 0.5) * (2.0 / kTupleCells) - 1);
    lights[kCellTexels * item] = vec4(normalize(dot(weighted, weighted) > 0 ? weighted : middle), 0);
    lights[kCellTexels * item + 1] = vec4(energy, 0);
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item < 6 * kSphereCubeBordered * kSphereCubeBordered) writeTexel(item);
    if (item < kTupleLights) writeLight(item);
}
