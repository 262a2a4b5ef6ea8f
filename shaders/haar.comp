#version 460
// The Haar levels above those of transport.comp: its averages, 4×4 to a lane, then each face's last block.
// One group a row, a lane a block of the second stage. CPU twin: haarFaces in precompute/reference/transport_stages.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/haar_step.glsl"

layout(constant_id = 0) const uint kFaceSize = 64; // F
layout(local_size_x_id = 1) in;                    // 6 (F / 16)²

layout(binding = 0, std430) buffer Coefficients { vec4 coefficients[]; }; // averages first, then what they become
layout(binding = 1, scalar) writeonly buffer Blocks { BlockSummary blocks[]; };

const uint kBlocks = kFaceSize / 16; // a side, of this stage
const uint kLanes = 6 * kBlocks * kBlocks;
shared vec3 averages[kLanes];

void storeCoefficient(uint row, uint face, uvec2 place, vec3 value, float squared) {
    coefficients[((row * 6 + face) * kFaceSize + place.y) * kFaceSize + place.x] = vec4(value, squared);
}

void main() {
    const uint lane = gl_LocalInvocationID.x, row = gl_WorkGroupID.x;
    const uint face = lane / (kBlocks * kBlocks), inFace = lane % (kBlocks * kBlocks);
    const uvec2 block = uvec2(inFace % kBlocks, inFace / kBlocks);
    const uint firstBlock = row * HAAR_BLOCKS(kFaceSize) + HAAR_FINE_BLOCKS(kFaceSize);

    vec3 values[16];
    for (uint i = 0; i < 16; i++) {
        const uvec2 place = block * 4 + uvec2(i % 4, i / 4);
        values[i] = coefficients[((row * 6 + face) * kFaceSize + place.y) * kFaceSize + place.x].rgb;
    }
    barrier(); // what follows overwrites what others read
    BlockSummary summary = BlockSummary(0, 0);
    averages[lane] = haarBlock(values, row, face, block, kBlocks, summary);
    blocks[firstBlock + lane] = summary;
    barrier();

    if (lane >= 6) return;
    summary = BlockSummary(0, 0);
    vec3 average;
    const uint first = lane * kBlocks * kBlocks;
    if (kBlocks == 4) {
        for (uint i = 0; i < 16; i++) values[i] = averages[first + i];
        average = haarBlock(values, row, lane, uvec2(0), 1, summary);
    } else {
        average = haarStep(averages[first], averages[first + 1], averages[first + 2], averages[first + 3], row, lane,
                           uvec2(0), 12, 1, summary);
    }
    addCoefficient(row, lane, uvec2(0), average, summary);
    blocks[firstBlock + kLanes + lane] = summary;
}
