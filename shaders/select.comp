#version 460
// The N coefficients of largest magnitude of each row, in linear time: a radix search, 11 + 11 + 10 bits from
// the top, for the N-th largest key (squared magnitudes are positive floats, so their bits sort as they
// do), then a stable compaction. Of equal keys the first are kept; zeros never are. One group a row.
// CPU twin: selectLargest in precompute/reference/transport_stages.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bake.h"

layout(local_size_x = 256) in;
layout(constant_id = 0) const uint kCount = 6 * 64 * 64; // coefficients of a row, a multiple of 256

layout(push_constant, scalar) uniform Push { RowsPush push; };
layout(binding = 0, std430) readonly buffer Coefficients { vec4 coefficients[]; };
layout(binding = 1, scalar) writeonly buffer Selected { uint selected[]; }; // N places a row
layout(binding = 2, scalar) writeonly buffer Counts { uint counts[]; };
layout(binding = 3, scalar) writeonly buffer Statistics { RowStatistics statistics[]; };

const uint kLanes = 256;
const uint kBins = 2048;
const uint kBinsPerLane = kBins / kLanes;

shared uint bins[kBins];
shared uint laneSums[kLanes];
shared float laneEnergies[kLanes];
shared uint foundBin, foundAbove;

uint gFirst; // the row's first coefficient
uint key(uint i) { return floatBitsToUint(coefficients[gFirst + i].w); }

// Finds the bin, from the top, in which the running count reaches `wanted` (≥ 1); foundAbove becomes the
// count in the bins above it. With fewer than `wanted` in all bins, finds bin 0.
void findBin(uint wanted) {
    const uint lane = gl_LocalInvocationID.x;
    barrier();
    uint sum = 0;
    for (uint i = 0; i < kBinsPerLane; i++) sum += bins[lane * kBinsPerLane + i];
    laneSums[lane] = sum;
    barrier();
    if (lane == 0) {
        uint above = 0;
        uint owner = kLanes - 1;
        while (owner > 0 && above + laneSums[owner] < wanted) above += laneSums[owner--];
        uint bin = owner * kBinsPerLane + kBinsPerLane - 1;
        while (bin > owner * kBinsPerLane && above + bins[bin] < wanted) above += bins[bin--];
        foundBin = bin;
        foundAbove = above;
    }
    barrier();
}

void clearBins() {
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < kBins; i += kLanes) bins[i] = 0;
    barrier();
}

void main() {
    const uint lane = gl_LocalInvocationID.x, row = gl_WorkGroupID.x;
    gFirst = row * kCount;

    // A bound from below: N lanes whose largest key is at least b prove that the N-th largest is.
    uint largest = 0;
    for (uint i = lane; i < kCount; i += kLanes) largest = max(largest, key(i));
    uint bound = 1;
    if (push.kept <= kLanes) {
        clearBins();
        atomicAdd(bins[largest >> 21], 1);
        findBin(push.kept);
        bound = max(foundBin << 21, 1);
    }

    // The N-th largest key, digit by digit: `prefix` holds the digits found, `wanted` its rank among the
    // keys that share them.
    uint prefix = 0, wanted = push.kept;
    for (uint digit = 0; digit < 3; digit++) {
        const uint shift = uint[](21u, 10u, 0u)[digit];
        const uint fixedShift = uint[](31u, 21u, 10u)[digit]; // keys are below 2³¹
        clearBins();
        for (uint i = lane; i < kCount; i += kLanes) {
            const uint k = key(i);
            if (k >= bound && k >> fixedShift == prefix >> fixedShift)
                atomicAdd(bins[(k >> shift) & (digit == 2 ? 1023 : 2047)], 1);
        }
        findBin(wanted);
        prefix |= foundBin << shift;
        wanted -= min(foundAbove, wanted);
    }

    // With fewer than N keys that are not zero the search ends at the bound or at 0: keep all of them.
    const uint threshold = max(prefix, 1);

    // Each lane compacts a run of neighbours; counts of larger keys in the low half, of equal in the high.
    const uint run = kCount / kLanes;
    uint found = 0;
    float dropped = 0;
    for (uint i = lane * run; i < (lane + 1) * run; i++) {
        const uint k = key(i);
        found += uint(k > threshold) + (uint(k == threshold) << 16);
        dropped += k < threshold ? uintBitsToFloat(k) : 0;
    }
    laneSums[lane] = found;
    laneEnergies[lane] = dropped;
    barrier();
    uint before = 0;
    for (uint i = 0; i < kLanes; i++) before += i < lane ? laneSums[i] : 0;
    uint equalBefore = before >> 16;
    uint place = (before & 0xffff) + min(equalBefore, wanted);
    for (uint i = lane * run; i < (lane + 1) * run; i++) {
        const uint k = key(i);
        const bool equal = k == threshold;
        if (k > threshold || (equal && equalBefore < wanted)) selected[row * push.kept + place++] = i;
        equalBefore += uint(equal);
    }
    if (lane == kLanes - 1) counts[row] = place;
    if (lane == 0) {
        float total = 0;
        uint equal = 0;
        for (uint i = 0; i < kLanes; i++) {
            total += laneEnergies[i];
            equal += laneSums[i] >> 16;
        }
        statistics[row].dropped = total + float(equal - min(equal, wanted)) * uintBitsToFloat(threshold);
    }
}
