#version 460
// Selects the N coefficients of largest magnitude of each row. Of equal ones the first are kept; zeros never are.
//
// Squared magnitudes are positive floats, so their bits, here called keys, have the same order, and a radix search
// finds the N-th largest. It starts with the largest key of each block: if N blocks have a key of at least b, the
// N-th largest is at least b. Only blocks that reach b are then read, and of their keys those that reach it are
// searched. They are listed if they fit; if not, those that reach a higher bound are, which is found by counting all of
// these keys in the same bins. If even these do not fit, the search goes through all slots of these blocks repeatedly.
// The selection is stored as a bit per coefficient, so that it comes out in order. One work-group per row.
// CPU twin: selectLargest() in precompute/twins/transport_twin.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/haar_step.glsl"
#include "shaders/shared/bake.h"

layout(constant_id = 0) const uint kFaceSize = 64; // F
layout(local_size_x_id = 1) in;                    // at most 64

layout(push_constant, scalar) uniform Push { RowsPush push; };
layout(binding = 0, scalar) readonly buffer Coefficients { vec3 coefficients[]; }; // lib/haar_block.glsl
layout(binding = 0, std430) readonly buffer Quarters { vec4 quarters[]; }; // the same, faster to read
layout(binding = 1, scalar) readonly buffer Summaries { vec2 summaries[]; };        // of blocks
layout(binding = 2, scalar) writeonly buffer Selected { uint selected[]; }; // N per row
layout(binding = 3, scalar) writeonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Statistics { RowStatistics statistics[]; };

const uint kLanes = gl_WorkGroupSize.x;
const uint kCount = 6 * kFaceSize * kFaceSize;
const uint kWords = kCount / 32;
const uint kBlocks = HAAR_BLOCKS(kFaceSize);
const uint kBins = 256;
// Capacity of the list of keys. With it, shared memory takes less than the 20 KiB that whyUnsuitable() demands.
const uint kCapacity = 736;

shared uint bins[kBins];
shared uvec2 laneSums[kLanes];
shared float laneEnergies[kLanes];
shared uint blockList[kBlocks]; // blocks that are read; above 16 bits the slots that reach the bound
shared uint keyList[kCapacity], slotList[kCapacity]; // candidates, if they fit: key, 16 · block + slot
shared uvec2 kept[kWords]; // a bit per coefficient: above the threshold; equal to it
shared uint foundBin, foundAbove, foundCount;
shared uvec2 total;

// Bins of squared magnitudes, four per octave, from 2⁻⁴⁰ to 2²⁴; values outside share the first and the last.
const uint kBoundShift = 21;
const int kFirstBound = (127 - 40) * 4;
uint boundBin(uint key) { return uint(clamp(int(key >> kBoundShift) - kFirstBound, 0, int(kBins) - 1)); }

uint blockKey(uint row, uint block) { return floatBitsToUint(summaries[row * kBlocks + block].x); }

uint key(uint row, uint slot) {
    return floatBitsToUint(squaredMagnitude(coefficients[16 * kBlocks * row + slot]));
}

// Return slot and key of candidate `i`: from the list, or among all slots of the blocks that are read.
uint candidateSlot(uint i, bool isListed) {
    return isListed ? slotList[i] : 16 * (blockList[i / 16] & 0xffff) + i % 16;
}

uint candidateKey(uint row, uint i, bool isListed) {
    if (isListed) return keyList[i];
    return (blockList[i / 16] >> (16 + i % 16) & 1) != 0 ? key(row, candidateSlot(i, false)) : 0;
}

void clearBins() {
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < kBins; i += kLanes) bins[i] = 0;
    barrier();
}

// Finds the bin, from the top, in which the running count reaches `wanted` (≥ 1), and sets foundAbove to the count in
// the bins above it. If all bins have fewer than `wanted`, finds bin 0.
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

// Returns the sum over the lanes before this one; sets `total` to the sum over all.
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
    const uint lane = gl_LocalInvocationID.x, row = gl_WorkGroupID.x, rowOut = push.firstRow + row;
    for (uint i = lane; i < kWords; i += kLanes) kept[i] = uvec2(0);

    uint bound = 1;
    clearBins();
    for (uint i = lane; i < (push.kept <= kBlocks ? kBlocks : 0); i += kLanes) {
        const uint k = blockKey(row, i);
        if (k != 0) atomicAdd(bins[boundBin(k)], 1);
    }
    findBin(push.kept);
    if (foundBin > 0) bound = (foundBin + kFirstBound) << kBoundShift;

    uint read = 0;
    float dropped = 0;
    for (uint i = lane; i < kBlocks; i += kLanes) {
        const vec2 summary = summaries[row * kBlocks + i];
        const bool isRead = floatBitsToUint(summary.x) >= bound;
        read += uint(isRead);
        dropped += isRead ? 0 : summary.y;
    }
    uint place = sumBefore(uvec2(read, 0)).x;
    for (uint i = lane; i < kBlocks; i += kLanes)
        if (blockKey(row, i) >= bound) blockList[place++] = i;
    barrier();
    const uint readBlocks = total.x;

    uint reaching = 0;
    for (uint i = lane; i < readBlocks; i += kLanes) {
        const uint block = blockList[i];
        float floats[48];
        for (uint j = 0; j < 12; j++) {
            const vec4 quarter = quarters[12 * (kBlocks * row + block) + j];
            for (uint k = 0; k < 4; k++) floats[4 * j + k] = quarter[k];
        }
        const uint held = haarCoefficientSlots(block, kFaceSize);
        uint slots = 0;
        for (uint slot = 0; slot < 16; slot++) {
            if ((held >> slot & 1) == 0) continue;
            const float squared = squaredMagnitude(vec3(floats[3 * slot], floats[3 * slot + 1], floats[3 * slot + 2]));
            const bool reaches = floatBitsToUint(squared) >= bound;
            slots |= uint(reaches) << slot;
            dropped += reaches ? 0 : squared;
        }
        blockList[i] = slots << 16 | block;
        reaching += bitCount(slots);
    }
    place = sumBefore(uvec2(reaching, 0)).x;
    if (total.x > kCapacity) { // too many for the list: finds a higher bound, and drops those below it
        clearBins();
        for (uint i = lane; i < readBlocks; i += kLanes)
            for (uint slots = blockList[i] >> 16; slots != 0; slots &= slots - 1)
                atomicAdd(bins[boundBin(key(row, 16 * (blockList[i] & 0xffff) + findLSB(slots)))], 1);
        findBin(push.kept);
        bound = foundBin > 0 ? (foundBin + kFirstBound) << kBoundShift : bound;
        reaching = 0;
        for (uint i = lane; i < readBlocks; i += kLanes) {
            const uint block = blockList[i] & 0xffff;
            uint left = 0;
            for (uint slots = blockList[i] >> 16; slots != 0; slots &= slots - 1) {
                const uint slot = findLSB(slots), k = key(row, 16 * block + slot);
                left |= uint(k >= bound) << slot;
                dropped += k >= bound ? 0 : uintBitsToFloat(k);
            }
            blockList[i] = left << 16 | block;
            reaching += bitCount(left);
        }
        place = sumBefore(uvec2(reaching, 0)).x;
    }
    const bool isListed = total.x <= kCapacity;
    for (uint i = lane; i < (isListed ? readBlocks : 0); i += kLanes) {
        const uint block = blockList[i] & 0xffff;
        for (uint slots = blockList[i] >> 16; slots != 0; slots &= slots - 1)
            slotList[place++] = 16 * block + findLSB(slots);
    }
    const uint candidates = isListed ? total.x : 16 * readBlocks;
    barrier();
    for (uint i = lane; i < (isListed ? candidates : 0); i += kLanes)
        keyList[i] = key(row, slotList[i]);

    // Finds the N-th largest key digit by digit. `prefix` holds the digits found, `wanted` the key's rank among those
    // that share them. If all of these are wanted, the search is over.
    uint prefix = 0, wanted = push.kept;
    bool whole = false;
    for (uint digit = 0; digit < 4 && !whole; digit++) {
        const uint shift = digit < 3 ? 23 - 8 * digit : 0; // keys are below 2³¹, the last digit has 7 bits
        clearBins();
        for (uint i = lane; i < candidates; i += kLanes) {
            const uint k = candidateKey(row, i, isListed);
            if (k >= bound && k >> (31 - 8 * digit) == prefix >> (31 - 8 * digit))
                atomicAdd(bins[k >> shift & (digit == 3 ? 127 : 255)], 1);
        }
        findBin(wanted);
        prefix |= foundBin << shift;
        wanted -= min(foundAbove, wanted);
        whole = foundCount == wanted;
    }

    // With fewer than N keys that are not zero the search ends at 0, and all of them are kept.
    const uint threshold = whole ? max(prefix, bound) - 1 : max(prefix, 1);
    for (uint i = lane; i < candidates; i += kLanes) {
        const uint k = candidateKey(row, i, isListed);
        if (k > threshold || k == threshold && k > 0) {
            const uint slot = candidateSlot(i, isListed);
            const uint coefficient = haarCoefficient(slot / 16, slot % 16, kFaceSize);
            atomicOr(kept[coefficient / 32][k > threshold ? 0 : 1], 1u << coefficient % 32);
        } else if (k >= bound) {
            dropped += uintBitsToFloat(k);
        }
    }
    barrier();
    if (whole) wanted = 0;

    uvec2 found = uvec2(0); // larger, equal
    const uint run = kWords / kLanes;
    for (uint i = lane * run; i < (lane + 1) * run; i++) found += uvec2(bitCount(kept[i]));
    const uvec2 before = sumBefore(found);
    uint equalBefore = before.y;
    place = before.x + min(equalBefore, wanted);
    for (uint i = lane * run; i < (lane + 1) * run; i++) {
        const uvec2 word = kept[i];
        for (uint bits = word.x | word.y; bits != 0; bits &= bits - 1) {
            const uint bit = findLSB(bits);
            const bool isEqual = (word.y >> bit & 1) != 0;
            if (!isEqual || equalBefore < wanted) selected[rowOut * push.kept + place++] = 32 * i + bit;
            equalBefore += uint(isEqual);
        }
    }
    laneEnergies[lane] = dropped;
    barrier();
    if (lane != 0) return;
    const uint keptEqual = min(total.y, wanted);
    dropped = 0;
    for (uint i = 0; i < kLanes; i++) dropped += laneEnergies[i];
    counts[rowOut] = total.x + keptEqual;
    statistics[rowOut].dropped = dropped + float(total.y - keptEqual) * uintBitsToFloat(threshold);
}
