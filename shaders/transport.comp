#version 460
// Transport of one term over one cube face of one point, in the Haar basis.
//
// A lane evaluates light map × cosine × solid angle × visible fraction for a block of 4×4 lighting texels,
// does two wavelet levels in registers, and shares the remaining average with its group for the other
// levels. CPU twins: transportVector and haarFaces in precompute/reference/transport_stages.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/shared/bake.h"

layout(constant_id = 0) const uint kFaceSize = 64;       // F, lighting texels a side
layout(constant_id = 1) const uint kVisibilitySize = 256; // a multiple of F, at most 8 F
layout(constant_id = 2) const uint kSamplesPerSide = 1;  // evaluations a side of a lighting texel
layout(constant_id = 3) const uint kMapSize = 48;
layout(constant_id = 4) const uint kMapping = 0;
layout(local_size_x_id = 5) in; // (F / 4)²

layout(push_constant, scalar) uniform Push { TransportPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Visible { uint visible[]; };
layout(binding = 2) uniform sampler2DArray lightMaps;
// Row after row of 6 F² coefficients: r, g, b, and r² + g² + b² to select by.
layout(binding = 3, std430) writeonly buffer Coefficients { vec4 coefficients[]; };

const uint kBlocks = kFaceSize / 4;
const uint kRatio = kVisibilitySize / kFaceSize;
const uint kCell = kRatio / kSamplesPerSide; // visibility texels a side of one evaluation

shared vec3 averages[kBlocks * kBlocks];

uint gFirstCoefficient;

void store(uint x, uint y, vec3 value) {
    precise float magnitude = value.r * value.r + value.g * value.g + value.b * value.b;
    coefficients[gFirstCoefficient + y * kFaceSize + x] = vec4(value, magnitude);
}

// One Haar step on [a b; c d]: writes the three details of place (x, y) at this level, returns the average.
vec3 haarStep(vec3 a, vec3 b, vec3 c, vec3 d, uint x, uint y, uint width) {
    store(x + width, y, 0.5 * (a - b + c - d));
    store(x, y + width, 0.5 * (a + b - c - d));
    store(x + width, y + width, 0.5 * (a - b - c + d));
    return 0.5 * (a + b + c + d);
}

void main() {
    const uint term = gl_WorkGroupID.z % push.terms, point = gl_WorkGroupID.z / push.terms;
    const uint face = gl_WorkGroupID.y;
    const uvec2 block = uvec2(gl_LocalInvocationID.x % kBlocks, gl_LocalInvocationID.x / kBlocks);
    gFirstCoefficient = (gl_WorkGroupID.z * 6 + face) * kFaceSize * kFaceSize;

    // The block's visibility, one word a row of texels: 4 · ratio bits of each are ours.
    uint rows[4 * kRatio];
    const uint wordsPerRow = kVisibilitySize / 32;
    const uint bit = block.x * 4 * kRatio;
    const uint firstWord =
        ((point * 6 + face) * kVisibilitySize + block.y * 4 * kRatio) * wordsPerRow + bit / 32;
    for (uint i = 0; i < 4 * kRatio; i++) rows[i] = visible[firstWord + i * wordsPerRow] >> (bit % 32);

    const mat3 frame = tangentFrame(points[point].normal) * kFaceAxes[face];
    const float cellWidth = 2.0 / float(kFaceSize * kSamplesPerSide);
    vec3 texels[16];
    for (uint i = 0; i < 16; i++) {
        const uvec2 texel = uvec2(i % 4, i / 4);
        vec3 sum = vec3(0);
        for (uint j = 0; j < kSamplesPerSide * kSamplesPerSide; j++) {
            const uvec2 cell = texel * kSamplesPerSide + uvec2(j % kSamplesPerSide, j / kSamplesPerSide);
            uint count = 0;
            for (uint row = 0; row < kCell; row++)
                count += bitCount(bitfieldExtract(rows[cell.y * kCell + row], int(cell.x * kCell), int(kCell)));
            const vec2 uv = (vec2(block * 4 * kSamplesPerSide + cell) + 0.5) * cellWidth - 1;
            const vec3 local = normalize(frame * vec3(uv, 1));
            const float fraction = float(count) / float(kCell * kCell);
            const float weight = max(local.z, 0) * cubeSolidAngle(uv, cellWidth) * fraction;
            sum += weight * lookupMap(lightMaps, int(push.firstTerm + term), mapFootprint(kMapping, int(kMapSize), local));
        }
        texels[i] = sum;
    }

    vec3 quads[4];
    for (uint i = 0; i < 4; i++) {
        const uint corner = (i / 2) * 8 + (i % 2) * 2;
        quads[i] = haarStep(texels[corner], texels[corner + 1], texels[corner + 4], texels[corner + 5],
                            block.x * 2 + i % 2, block.y * 2 + i / 2, kFaceSize / 2);
    }
    averages[gl_LocalInvocationID.x] =
        haarStep(quads[0], quads[1], quads[2], quads[3], block.x, block.y, kFaceSize / 4);

    for (uint width = kBlocks / 2; width >= 1; width /= 2) {
        barrier();
        const uint x = gl_LocalInvocationID.x % width, y = gl_LocalInvocationID.x / width;
        const bool working = y < width;
        vec3 average = vec3(0);
        if (working) {
            const uint corner = 2 * y * 2 * width + 2 * x;
            average = haarStep(averages[corner], averages[corner + 1], averages[corner + 2 * width],
                               averages[corner + 2 * width + 1], x, y, width);
        }
        barrier();
        if (working) averages[gl_LocalInvocationID.x] = average;
    }
    if (gl_LocalInvocationID.x == 0) store(0, 0, averages[0]);
}
