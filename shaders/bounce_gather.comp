#version 460
// Gathers one bounce of light to a vertex: sums, over the surfaces that it sees, what they send it, times its light
// maps.
//
// The rows of a surface are added to its radiance in shared memory, as integers, whose order does not matter: steps are
// such that no sum reaches 2³¹. Each lane then adds the radiance of its own coefficients to all terms, which it keeps in
// registers. One work-group per vertex and group of terms. CPU twin: BounceGather in precompute/bounce/bounce_gather.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/haar_step.glsl"
#include "shaders/lib/packing.glsl"
#include "shaders/shared/bake.h"

layout(constant_id = 0) const uint kTerms = 8; // summed at a time
layout(local_size_x_id = 1) in;                // a divisor of kCoefficients

layout(push_constant, scalar) uniform Push { BounceGatherPush push; };
layout(binding = 0, scalar) readonly buffer HitStarts { uint hitStarts[]; }; // per vertex, and the end
layout(binding = 1, scalar) readonly buffer Hits { SourceHit hits[]; };
layout(binding = 2, scalar) readonly buffer Steps { vec3 steps[]; }; // per hit and row: of a packed value
layout(binding = 3, std430) readonly buffer Light { vec4 light[]; }; // per hit and term: light map · weight of the ray
layout(binding = 4, scalar) readonly buffer RowStarts { uint rowStarts[]; }; // of the sources, and the end
layout(binding = 5, scalar) readonly buffer Indices { uint indices[]; };     // two per word
layout(binding = 6, scalar) readonly buffer Values { uint values[]; };
layout(binding = 7, scalar) writeonly buffer Coefficients { vec3 coefficients[]; }; // lib/haar_block.glsl
layout(binding = 8, scalar) writeonly buffer Summaries { vec2 summaries[]; };       // of blocks

const uint kLanes = gl_WorkGroupSize.x;
const uint kFaceSize = 16; // of bounced light
const uint kCoefficients = 6 * kFaceSize * kFaceSize;
const uint kOwn = kCoefficients / kLanes; // coefficients of a lane
const uint kRowLanes = 64;                // lanes that read a row
const uint kPackedFaceSize = 32;          // of the rows that are packed; finer coefficients are zero
const float kScale = float(kFaceSize) / float(kPackedFaceSize); // of its coefficients
const uint kBlocks = HAAR_BLOCKS(kPackedFaceSize);

shared int radiance[3 * kCoefficients]; // of a hit, in steps; at the end, the bits of a row's floats

void addRows(uint number, SourceHit hit) {
    const uint lane = gl_LocalInvocationID.x;
    for (uint row = lane / kRowLanes; row < hit.rows; row += kLanes / kRowLanes) {
        const vec3 rowSteps = steps[number * push.sourceTerms + row];
        const uint end = rowStarts[hit.firstRow + row + 1];
        for (uint entry = rowStarts[hit.firstRow + row] + lane % kRowLanes; entry < end; entry += kRowLanes) {
            const uint index = bitfieldExtract(indices[entry / 2], int(16 * (entry % 2)), 16);
            const ivec3 added = ivec3(floor(vec3(unpackCoefficient(values[entry])) * rowSteps + 0.5));
            for (int channel = 0; channel < 3; channel++) atomicAdd(radiance[3 * index + channel], added[channel]);
        }
    }
}

// Stores a row from shared memory, block by block, as coefficients of the larger cube.
void storeRow(uint row) {
    for (uint block = gl_LocalInvocationID.x; block < kBlocks; block += kLanes) {
        const uint held = haarCoefficientSlots(block, kPackedFaceSize);
        vec2 summary = vec2(0);
        for (uint slot = 0; slot < 16; slot++) {
            const uint coefficient = haarCoefficient(block, slot, kPackedFaceSize);
            const uint face = coefficient / (kPackedFaceSize * kPackedFaceSize),
                       y = coefficient / kPackedFaceSize % kPackedFaceSize, x = coefficient % kPackedFaceSize;
            vec3 value = vec3(0);
            if ((held >> slot & 1) != 0 && x < kFaceSize && y < kFaceSize) {
                const uint index = 3 * ((face * kFaceSize + y) * kFaceSize + x);
                value = kScale * intBitsToFloat(ivec3(radiance[index], radiance[index + 1], radiance[index + 2]));
                addToSummary(value, summary);
            }
            coefficients[16 * (row * kBlocks + block) + slot] = value;
        }
        summaries[row * kBlocks + block] = summary;
    }
}

void main() {
    const uint lane = gl_LocalInvocationID.x, vertex = gl_WorkGroupID.x, firstTerm = gl_WorkGroupID.y * kTerms;
    const uint terms = min(kTerms, push.terms - firstTerm);
    vec3 sums[kOwn][kTerms];
    for (uint i = 0; i < kOwn; i++)
        for (uint term = 0; term < kTerms; term++) sums[i][term] = vec3(0);
    for (uint i = lane; i < 3 * kCoefficients; i += kLanes) radiance[i] = 0;
    barrier();

    // GPU-assisted validation adds branches to each load; lavapipe refuses them in the condition of a loop.
    const uint hitsEnd = hitStarts[vertex + 1];
    for (uint number = hitStarts[vertex]; number < hitsEnd; number++) {
        const SourceHit hit = hits[number];
        addRows(number, hit);
        barrier();
        vec3 arriving[kOwn];
        for (uint i = 0; i < kOwn; i++) {
            const uint index = 3 * (lane + i * kLanes);
            arriving[i] = hit.unit * vec3(radiance[index], radiance[index + 1], radiance[index + 2]);
            for (uint channel = 0; channel < 3; channel++) radiance[index + channel] = 0;
        }
        barrier();
        for (uint term = 0; term < kTerms; term++) {
            const vec3 reflected = light[number * push.terms + firstTerm + min(term, terms - 1)].rgb;
            for (uint i = 0; i < kOwn; i++) sums[i][term] += arriving[i] * reflected;
        }
    }

    for (uint term = 0; term < terms; term++) {
        for (uint i = 0; i < kOwn; i++)
            for (uint channel = 0; channel < 3; channel++)
                radiance[3 * (lane + i * kLanes) + channel] = floatBitsToInt(sums[i][term][channel]);
        barrier();
        storeRow(vertex * push.terms + firstTerm + term);
        barrier();
    }
}
