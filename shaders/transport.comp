#version 460
// Computes the transport of all terms over one cube face of one point, in the Haar basis.
//
// A lane takes a block of 4×4 lighting texels that light reaches, evaluates light map × cosine × solid angle ×
// visible fraction, and transforms it by two levels. The places and weights of lookups, which all terms share, are
// found once. Then lanes take blocks of 4×4 averages, and then the face's last blocks. Blocks come from a list: idle
// lanes would cost software devices as much as busy ones.
// CPU twins: transportVector() in precompute/twins/transport_twin.h, haarForwardFaces() in engine/math/haar.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/haar_step.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/shared/bake.h"

layout(constant_id = 0) const uint kFaceSize = 64; // F, lighting texels along a side
layout(constant_id = 1) const uint kVisibilitySize = 256; // a multiple of F, at most 8 F
layout(constant_id = 2) const uint kSamplesPerSide = 1; // evaluations along a lighting texel's side
layout(constant_id = 3) const uint kMapping = 0;
layout(constant_id = 4) const uint kTermCapacity = 8; // at least the terms of every dispatch
layout(local_size_x_id = 5) in;

layout(push_constant, scalar) uniform Push { TransportPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Visible { uint visible[]; };
// Texel ((y (S + 1) + x) K + term) 3 + channel has the four corners of a lookup between the map's texels x - 1 and x,
// y - 1 and y. It is a buffer, not an image, because software devices compute an image's address anew, with level and
// layer, for each fetch.
TEXELS(2, vec4, samplerBuffer, Corners, corners);
layout(binding = 3, std430) coherent buffer Coefficients { vec4 coefficients[]; }; // lib/haar_block.glsl
layout(binding = 4, scalar) writeonly buffer Summaries { vec2 summaries[]; };      // of blocks

const uint kLanes = gl_WorkGroupSize.x;
const uint kBlocks = kFaceSize / 4; // along a side
const uint kFaceBlocks = kBlocks * kBlocks;
const uint kRowBlocks = HAAR_BLOCKS(kFaceSize);
const uint kCoarse = kFaceSize / 16; // blocks of the second stage along a side
const uint kCoarseBlocks = kCoarse * kCoarse;
const uint kRatio = kVisibilitySize / kFaceSize;
const uint kCell = kRatio / kSamplesPerSide; // visibility texels along a side of one evaluation
const uint kBlockBits = 4 * kRatio; // visibility texels along a side of a block
const uint kWordsPerLine = kVisibilitySize / 32;
// Without a loop over terms, the places of all 16 lookups need not be stored, which is a quarter faster on lavapipe.
const bool kOneTerm = kTermCapacity == 1;

// The face's blocks: those that light reaches from the front, in any order, the others from the back.
shared uint blockList[kFaceBlocks];
shared uint reachedBlocks, otherBlocks;
shared vec3 averages[kTermCapacity * kCoarseBlocks]; // of the second stage
uint lines[kBlockBits]; // a block's visibility: a word per line, in its lowest bits

// The corners of a lookup in `corners`, and their weights.
struct Place {
    int texel; // texel of the first term's red
    vec4 weights;
};

// Returns the place of evaluation number `cell` of a block.
Place placeOf(uvec2 block, uvec2 cell, uint face, mat3 frame) {
    const float cellWidth = 2.0 / float(kFaceSize * kSamplesPerSide);
    uint count = 0;
    for (uint line = 0; line < kCell; line++)
        count += bitCount(bitfieldExtract(lines[cell.y * kCell + line], int(cell.x * kCell), int(kCell)));
    const vec2 uv = (vec2(block * 4 * kSamplesPerSide + cell) + 0.5) * cellWidth - 1;
    const vec3 local = normalize(frame * vec3(uv, 1));
    const float fraction = float(count) / float(kCell * kCell);
    const float weight = max(local.z, 0) * cubeSolidAngle(uv, cellWidth) * fraction;
    const vec2 place = diskMapCoordinates(kMapping, local) * float(push.mapSize) - 0.5;
    const vec2 corner = floor(place), right = place - corner, left = 1 - right;
    const ivec2 first = clamp(ivec2(corner) + 1, ivec2(0), ivec2(push.mapSize));
    return Place((first.y * int(push.mapSize + 1) + first.x) * int(3 * push.allTerms),
                 weight * vec4(left.x * left.y, right.x * left.y, left.x * right.y, right.x * right.y));
}

// Looks up with three fetches of four corners each. Many devices round a sampler's weights to 8 bits, and CPU twins
// do not.
vec3 weightedLookup(Place place, uint term) {
    const int texel = place.texel + 3 * int(term);
    return vec3(dot(texelOf(corners, texel), place.weights), dot(texelOf(corners, texel + 1), place.weights),
                dot(texelOf(corners, texel + 2), place.weights));
}

void storeBlock(uint place, vec3 slots[16], vec2 summary) {
    for (uint i = 0; i < 12; i++) coefficients[12 * place + i] = slotQuarter(slots, i);
    summaries[place] = summary;
}

void listBlocks(uint firstWord) {
    const uint lane = gl_LocalInvocationID.x;
    const uint blocksPerWord = 32 / kBlockBits;
    if (lane == 0) reachedBlocks = otherBlocks = 0;
    barrier();
    for (uint i = lane; i < kBlocks * kWordsPerLine; i += kLanes) {
        const uint word = firstWord + i / kWordsPerLine * kBlockBits * kWordsPerLine + i % kWordsPerLine;
        uint visibleBits = 0;
        for (uint line = 0; line < kBlockBits; line++) visibleBits |= visible[word + line * kWordsPerLine];
        for (uint j = 0; j < blocksPerWord; j++) {
            uint place;
            if (bitfieldExtract(visibleBits, int(j * kBlockBits), int(kBlockBits)) != 0)
                place = atomicAdd(reachedBlocks, 1);
            else
                place = kFaceBlocks - 1 - atomicAdd(otherBlocks, 1);
            blockList[place] = i * blocksPerWord + j;
        }
    }
    barrier();
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint face = gl_WorkGroupID.x, point = push.firstPoint + gl_WorkGroupID.y;
    const uint firstRow = gl_WorkGroupID.y * push.terms;
    const uint firstBlock = face * kFaceBlocks; // of a row
    const uint firstWord = (point * 6 + face) * kVisibilitySize * kWordsPerLine;
    vec3 values[16], slots[16];
    vec2 summary;
    listBlocks(firstWord);

    const mat3 frame = tangentFrame(points[point].normal, points[point].tangent) * kFaceAxes[face];
    for (uint entry = lane; entry < reachedBlocks; entry += kLanes) {
        const uint number = blockList[entry];
        const uvec2 block = uvec2(number % kBlocks, number / kBlocks);
        const uint bit = block.x * kBlockBits;
        const uint word = firstWord + block.y * kBlockBits * kWordsPerLine + bit / 32;
        for (uint line = 0; line < kBlockBits; line++)
            lines[line] = bitfieldExtract(visible[word + line * kWordsPerLine] >> (bit % 32), 0, int(kBlockBits));
        Place places[16];
        if (kSamplesPerSide == 1)
            for (uint i = 0; i < 16; i++) places[i] = placeOf(block, uvec2(i % 4, i / 4), face, frame);
        for (uint term = 0; term < (kOneTerm ? 1 : push.terms); term++) {
            for (uint i = 0; i < 16; i++) {
                if (kSamplesPerSide == 1) {
                    values[i] = weightedLookup(places[i], push.firstTerm + term);
                    continue;
                }
                values[i] = vec3(0);
                for (uint j = 0; j < kSamplesPerSide * kSamplesPerSide; j++) {
                    const uvec2 cell =
                        uvec2(i % 4, i / 4) * kSamplesPerSide + uvec2(j % kSamplesPerSide, j / kSamplesPerSide);
                    values[i] += weightedLookup(placeOf(block, cell, face, frame), push.firstTerm + term);
                }
            }
            haarBlock(values, slots, summary);
            storeBlock((firstRow + term) * kRowBlocks + firstBlock + number, slots, summary);
        }
    }
    for (uint entry = lane; entry < otherBlocks; entry += kLanes)
        for (uint term = 0; term < push.terms; term++) {
            const uint place = (firstRow + term) * kRowBlocks + firstBlock + blockList[kFaceBlocks - 1 - entry];
            coefficients[12 * place + 11] = vec4(0); // includes the average
            summaries[place] = vec2(0);
        }
    memoryBarrierBuffer();
    barrier();

    // The coarser stages.
    for (uint i = lane; i < push.terms * kCoarseBlocks; i += kLanes) {
        const uint firstPlace = (firstRow + i / kCoarseBlocks) * kRowBlocks, block = i % kCoarseBlocks;
        const uvec2 corner = 4 * uvec2(block % kCoarse, block / kCoarse);
        for (uint j = 0; j < 16; j++) {
            const uint finer = firstPlace + firstBlock + (corner.y + j / 4) * kBlocks + corner.x + j % 4;
            values[j] = coefficients[12 * finer + 11].yzw;
        }
        haarBlock(values, slots, summary);
        storeBlock(firstPlace + HAAR_FINE_BLOCKS(kFaceSize) + face * kCoarseBlocks + block, slots, summary);
        averages[i] = slots[15];
    }
    barrier();
    for (uint term = lane; term < push.terms; term += kLanes) {
        const uint first = term * kCoarseBlocks;
        if (kCoarse == 4) {
            for (uint i = 0; i < 16; i++) values[i] = averages[first + i];
            haarBlock(values, slots, summary);
        } else {
            summary = vec2(0);
            slots[15] = haarStep(averages[first], averages[first + 1], averages[first + 2], averages[first + 3], 12,
                                 slots, summary);
        }
        addToSummary(slots[15], summary);
        storeBlock((firstRow + term + 1) * kRowBlocks - 6 + face, slots, summary);
    }
}
