#version 460
// Transport of all terms over 4×4 lighting texels of one point, in the Haar basis, two levels deep.
//
// A lane evaluates light map × cosine × solid angle × visible fraction for its block. What the terms share,
// where to look and with which weight, is found once; blocks that nothing reaches are left out. haar.comp
// goes on with the averages. CPU twins: transportVector and haarFaces in precompute/reference/transport_stages.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/haar_step.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/shared/bake.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFaceSize = 64;       // F, lighting texels a side
layout(constant_id = 1) const uint kVisibilitySize = 256; // a multiple of F, at most 8 F
layout(constant_id = 2) const uint kSamplesPerSide = 1;  // evaluations a side of a lighting texel
layout(constant_id = 3) const uint kMapSize = 48;
layout(constant_id = 4) const uint kMapping = 0;
// Without a loop over terms, the places of all 16 lookups need not be kept: a quarter faster on lavapipe.
layout(constant_id = 5) const uint kTerms = 4;
const bool kOneTerm = kTerms == 1;

layout(push_constant, scalar) uniform Push { TransportPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Visible { uint visible[]; };
// Texel ((y (S + 1) + x) K + term) 3 + channel: the four corners of a lookup between the map's
// texels x - 1 and x, y - 1 and y.
layout(binding = 2) uniform samplerBuffer lightMaps;
// Row after row of 6 F² coefficients: r, g, b, and r² + g² + b² to select by. Details of empty blocks are not
// written; averages lie where the next stage's coefficients will.
layout(binding = 3, std430) writeonly buffer Coefficients { vec4 coefficients[]; };
layout(binding = 4, scalar) writeonly buffer Blocks { BlockSummary blocks[]; }; // of each row, HAAR_BLOCKS(F)

const uint kBlocks = kFaceSize / 4; // a side
const uint kRatio = kVisibilitySize / kFaceSize;
const uint kCell = kRatio / kSamplesPerSide; // visibility texels a side of one evaluation

void storeCoefficient(uint row, uint face, uvec2 place, vec3 value, float squared) {
    coefficients[((row * 6 + face) * kFaceSize + place.y) * kFaceSize + place.x] = vec4(value, squared);
}

// Where a lookup finds its corners and what each counts for.
struct Place {
    int texel;
    vec4 weights;
};

uint rows[4 * kRatio]; // the block's visibility, one word a row of texels: its lowest 4 · ratio bits

// `cell` counts evaluations from the block's first.
Place placeOf(uvec2 block, uvec2 cell, uint face, mat3 frame) {
    const float cellWidth = 2.0 / float(kFaceSize * kSamplesPerSide);
    uint count = 0;
    for (uint row = 0; row < kCell; row++)
        count += bitCount(bitfieldExtract(rows[cell.y * kCell + row], int(cell.x * kCell), int(kCell)));
    const vec2 uv = (vec2(block * 4 * kSamplesPerSide + cell) + 0.5) * cellWidth - 1;
    const vec3 local = normalize(frame * vec3(uv, 1));
    const float fraction = float(count) / float(kCell * kCell);
    const float weight = max(local.z, 0) * cubeSolidAngle(uv, cellWidth) * fraction;
    const vec2 place = diskMapCoordinates(kMapping, local) * float(kMapSize) - 0.5;
    const vec2 corner = floor(place), right = place - corner, left = 1 - right;
    const ivec2 cell2 = clamp(ivec2(corner) + 1, ivec2(0), ivec2(kMapSize));
    return Place((cell2.y * int(kMapSize + 1) + cell2.x) * int(3 * kTerms),
                 weight * vec4(left.x * left.y, right.x * left.y, left.x * right.y, right.x * right.y));
}

// Three fetches of four corners: samplers round weights to 8 bits on many devices, and CPU twins do not.
vec3 weightedLookup(Place place, int layer) {
    return vec3(dot(texelFetch(lightMaps, place.texel + layer), place.weights),
                dot(texelFetch(lightMaps, place.texel + layer + 1), place.weights),
                dot(texelFetch(lightMaps, place.texel + layer + 2), place.weights));
}

void main() {
    const uvec2 block = uvec2(gl_GlobalInvocationID.x % kBlocks, gl_GlobalInvocationID.x / kBlocks);
    const uint face = gl_GlobalInvocationID.y, point = gl_GlobalInvocationID.z;
    const vec3 normal = points[point].normal;
    const uint firstRow = point * push.terms;
    const uint blockInRow = face * kBlocks * kBlocks + gl_GlobalInvocationID.x;

    // Work that is left out is a loop of no iterations: devices without branches a lane leave loops early.
    const vec3 faceNormal = normal * kFaceAxes[face];
    const float blockWidth = 2.0 / float(kBlocks);
    const vec2 centre = (vec2(block) + 0.5) * blockWidth - 1;
    const float highest = dot(faceNormal, vec3(centre, 1)) +
                          (abs(faceNormal.x) + abs(faceNormal.y)) * (0.5 * blockWidth);
    uint any = 0;
    for (uint once = 0; once < uint(highest > 0); once++) {
        const uint wordsPerRow = kVisibilitySize / 32;
        const uint bit = block.x * 4 * kRatio;
        const uint firstWord =
            ((point * 6 + face) * kVisibilitySize + block.y * 4 * kRatio) * wordsPerRow + bit / 32;
        for (uint i = 0; i < 4 * kRatio; i++) {
            rows[i] = bitfieldExtract(visible[firstWord + i * wordsPerRow] >> (bit % 32), 0, int(4 * kRatio));
            any |= rows[i];
        }
    }

    for (uint once = 0; once < uint(any != 0); once++) {
        const mat3 frame = tangentFrame(normal) * kFaceAxes[face];
        Place places[16];
        if (kSamplesPerSide == 1)
            for (uint i = 0; i < 16; i++) places[i] = placeOf(block, uvec2(i % 4, i / 4), face, frame);
        for (uint term = 0; term < (kOneTerm ? 1 : push.terms); term++) {
            const int layer = int(3 * (push.firstTerm + term));
            vec3 texels[16];
            for (uint i = 0; i < 16; i++) {
                if (kSamplesPerSide == 1) {
                    texels[i] = weightedLookup(places[i], layer);
                    continue;
                }
                texels[i] = vec3(0);
                for (uint j = 0; j < kSamplesPerSide * kSamplesPerSide; j++) {
                    const uvec2 cell =
                        uvec2(i % 4, i / 4) * kSamplesPerSide + uvec2(j % kSamplesPerSide, j / kSamplesPerSide);
                    texels[i] += weightedLookup(placeOf(block, cell, face, frame), layer);
                }
            }
            const uint row = firstRow + term;
            BlockSummary summary = BlockSummary(0, 0);
            const vec3 average = haarBlock(texels, row, face, block, kBlocks, summary);
            storeCoefficient(row, face, block, average, 0);
            blocks[row * HAAR_BLOCKS(kFaceSize) + blockInRow] = summary;
        }
    }
    for (uint term = 0; term < (any == 0 ? push.terms : 0); term++) {
        const uint row = firstRow + term;
        storeCoefficient(row, face, block, vec3(0), 0);
        blocks[row * HAAR_BLOCKS(kFaceSize) + blockInRow] = BlockSummary(0, 0);
    }
}
