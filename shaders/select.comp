#version 460
// The N coefficients of largest magnitude of each row. Of equal ones the first are kept; zeros never are.
//
// Squared magnitudes are positive floats, so their bits sort as they do and a radix search finds the N-th
// largest. It is made first among the largest of each block: N blocks that hold a key of at least b prove
// that the N-th largest is. Only blocks that reach b are read then, to search among their keys. The set of
// what is kept becomes a bit a coefficient, so that it comes out in order. One group a row.
// CPU twin: selectLargest in precompute/reference/transport_stages.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/haar_block.glsl"
#include "shaders/shared/bake.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFaceSize = 64; // F

layout(push_constant, scalar) uniform Push { RowsPush push; };
layout(binding = 0, std430) readonly buffer Coefficients { vec4 coefficients[]; }; // unwritten in blocks of zeros
layout(binding = 1, scalar) readonly buffer Blocks { BlockSummary blocks[]; };
layout(binding = 2, scalar) writeonly buffer Selected { uint selected[]; }; // N places a row
layout(binding = 3, scalar) writeonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Statistics { RowStatistics statistics[]; };

const uint kLanes = 64;
const uint kCount = 6 * kFaceSize * kFaceSize;
const uint kWords = kCount / 32;
const uint kBlocks = HAAR_BLOCKS(kFaceSize);
const uint kBins = 256; // a digit of 8 bits; keys are below 2³¹, the last digit of four has 7
const uint kShifts[4] = uint[](23u, 15u, 7u, 0u);

shared uint bins[kBins];
shared uvec2 laneSums[kLanes];
shared float laneEnergies[kLanes];
shared uint blockList[kBlocks]; // those that are read
shared uint larger[kWords], equal[kWords]; // a bit a coefficient
shared uint foundBin, foundAbove, foundCount;
shared uvec2 total;

uint blockKey(uint row, uint block) { return floatBitsToUint(blocks[row * kBlocks + block].largest); }

// The coefficient, face · F² + y · F + x, of a slot of a block; kCount if there is none.
uint coefficientOf(uint block, uint slot) {
    const bool fine = block < HAAR_FINE_BLOCKS(kFaceSize);
    const bool coarse = !fine && block < HAAR_FINE_BLOCKS(kFaceSize) + HAAR_COARSE_BLOCKS(kFaceSize);
    const uint width = fine ? kFaceSize / 4 : coarse ? kFaceSize / 16 : 1;
    const uint inStage = block - (fine     ? 0
                                  : coarse ? HAAR_FINE_BLOCKS(kFaceSize)
                                           : HAAR_FINE_BLOCKS(kFaceSize) + HAAR_COARSE_BLOCKS(kFaceSize));
    const uint face = inStage / (width * width), inFace = inStage % (width * width);
    const bool none = fine || coarse ? slot == 15 : slot < 12 && kFaceSize == 32;
    const uvec2 place = haarSlotPlace(uvec2(inFace % width, inFace / width), slot, width);
    return none ? kCount : (face * kFaceSize + place.y) * kFaceSize + place.x;
}

uint key(uint row, uint coefficient) {
    return coefficient < kCount ? floatBitsToUint(coefficients[row * kCount + coefficient].w) : 0;
}

void clearBins() {
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < kBins; i += kLanes) bins[i] = 0;
    barrier();
}

// Finds the bin, from the top, in which the running count reaches `wanted` (≥ 1); foundAbove becomes the
// count in the bins above it. With fewer than `wanted` in all bins, finds bin 0.
void findBin(uint wanted) {
    const uint lane = gl_LocalInvocationID.x;
    const uint run = kBins / kLanes;
    barrier();
    uint sum = 0;
    for (uint i = 0; i < run; i++) sum += bins[lane * run + i];
    laneSums[lane].x = sum;
    barrier();
    if (lane == 0) {
        uint above = 0, owner = kLanes - 1;
        for (uint count; owner > 0 && above + (count = laneSums[owner].x) < wanted; owner--) above += count;
        uint bin = owner * run + run - 1;
        while (bin > owner * run && above + bins[bin] < wanted) above += bins[bin--];
        foundBin = bin;
        foundAbove = above;
        foundCount = bins[bin];
    }
    barrier();
}

// The sum over the lanes before this one; `total` becomes the sum over all.
uvec2 sumBefore(uvec2 value) {
    const uint lane = gl_LocalInvocationID.x;
    laneSums[lane] = value;
    barrier();
    if (lane == 0) {
        uvec2 sum = uvec2(0);
        for (uint i = 0; i < kLanes; i++) {
            const uvec2 next = laneSums[i];
            laneSums[i] = sum;
            sum += next;
        }
        total = sum;
    }
    barrier();
    return laneSums[lane];
}

void main() {
    const uint lane = gl_LocalInvocationID.x, row = gl_WorkGroupID.x;
    for (uint i = lane; i < kWords; i += kLanes) {
        larger[i] = 0;
        equal[i] = 0;
    }

    // Two digits of the N-th largest block are close enough.
    uint bound = 0;
    for (uint digit = 0, wanted = push.kept; digit < 2 && push.kept <= kBlocks; digit++) {
        clearBins();
        for (uint i = lane; i < kBlocks; i += kLanes) {
            const uint k = blockKey(row, i);
            if (k != 0 && (digit == 0 || k >> kShifts[0] == bound >> kShifts[0]))
                atomicAdd(bins[k >> kShifts[digit] & 255], 1);
        }
        findBin(wanted);
        bound |= foundBin << kShifts[digit];
        wanted -= min(foundAbove, wanted);
    }
    bound = max(bound, 1);

    uint read = 0;
    float dropped = 0;
    for (uint i = lane; i < kBlocks; i += kLanes) {
        const bool isRead = blockKey(row, i) >= bound;
        read += uint(isRead);
        if (!isRead) dropped += blocks[row * kBlocks + i].energy;
    }
    uint place = sumBefore(uvec2(read, 0)).x;
    for (uint i = lane; i < kBlocks; i += kLanes)
        if (blockKey(row, i) >= bound) blockList[place++] = i;
    const uint slots = 16 * total.x;

    // The N-th largest key, digit by digit: `prefix` holds the digits found, `wanted` its rank among the keys
    // that share them. Where all of these are wanted, the search is over.
    uint prefix = 0, wanted = push.kept;
    bool whole = false;
    for (uint digit = 0; digit < 4 && !whole; digit++) {
        clearBins();
        for (uint i = lane; i < slots; i += kLanes) {
            const uint k = key(row, coefficientOf(blockList[i / 16], i % 16));
            if (k >= bound && (digit == 0 || k >> kShifts[digit - 1] == prefix >> kShifts[digit - 1]))
                atomicAdd(bins[k >> kShifts[digit] & (digit == 3 ? 127 : 255)], 1);
        }
        findBin(wanted);
        prefix |= foundBin << kShifts[digit];
        wanted -= min(foundAbove, wanted);
        whole = foundCount == wanted;
    }

    // With fewer than N keys that are not zero the search ends at 0: keep all of them.
    const uint threshold = whole ? max(prefix, bound) - 1 : max(prefix, 1);
    for (uint i = lane; i < slots; i += kLanes) {
        const uint coefficient = coefficientOf(blockList[i / 16], i % 16);
        const uint k = key(row, coefficient);
        if (k > threshold)
            atomicOr(larger[coefficient / 32], 1u << coefficient % 32);
        else if (k == threshold && k > 0)
            atomicOr(equal[coefficient / 32], 1u << coefficient % 32);
        else
            dropped += uintBitsToFloat(k);
    }
    barrier();
    if (whole) wanted = 0;

    uvec2 found = uvec2(0); // larger, equal
    const uint run = kWords / kLanes;
    for (uint i = lane * run; i < (lane + 1) * run; i++) found += uvec2(bitCount(larger[i]), bitCount(equal[i]));
    const uvec2 before = sumBefore(found);
    uint equalBefore = before.y;
    place = before.x + min(equalBefore, wanted);
    for (uint i = lane * run; i < (lane + 1) * run; i++) {
        const uint equals = equal[i];
        for (uint bits = larger[i] | equals; bits != 0; bits &= bits - 1) {
            const uint bit = findLSB(bits);
            const bool isEqual = (equals >> bit & 1) != 0;
            if (!isEqual || equalBefore < wanted) selected[row * push.kept + place++] = 32 * i + bit;
            equalBefore += uint(isEqual);
        }
    }
    laneEnergies[lane] = dropped;
    barrier();
    if (lane != 0) return;
    const uint keptEqual = min(total.y, wanted);
    dropped = 0;
    for (uint i = 0; i < kLanes; i++) dropped += laneEnergies[i];
    counts[row] = total.x + keptEqual;
    statistics[row].dropped = dropped + float(total.y - keptEqual) * uintBitsToFloat(threshold);
}
