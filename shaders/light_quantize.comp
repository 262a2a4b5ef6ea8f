#version 460
// Selects the light's coefficients, quantizes them into a dense table that is zero elsewhere, and measures what that
// lost and how the table differs from that of the light before.
// One work-group makes several passes over all coefficients: for the maxima, the selection, the sums that guard the
// range, and the values. Everything that decides a value is an integer, or a float product that is exact or rounded
// once.
// C++ twin: makeLightVector() in engine/light/light_vector.h, which numbers the steps.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_packing.glsl"
#include "shaders/shared/render.h"

const uint kGroup = 128;
layout(local_size_x = kGroup) in;
layout(push_constant, scalar) uniform Push { LightQuantizePush push; };
layout(binding = 0, scalar) readonly buffer Coefficients { vec3 coefficients[]; };
layout(binding = 1, scalar) buffer Table { PackedLight table[]; }; // the light's entries, then their changes
layout(binding = 2, scalar) buffer Stats { LightStats stats; };
// The weights by which entries are selected, stored by the first pass. Every lane reads those that it wrote.
layout(binding = 3, scalar) buffer Weights { uint weights[]; };

shared uvec3 partial[kGroup];
shared vec2 energies[kGroup];
shared uint bins[kGroup];
shared uvec2 chosen; // a bin, and how many of its entries remain to be kept

// Magnitudes are compared as the bits of their floats, which have the same order.
const uint kExponent = 23; // lowest bit of the exponent
const uint kLeastNormal = 1u << kExponent;

uint largest(uvec3 v) { return max(v.r, max(v.g, v.b)); }

uvec3 magnitudesOf(uint index) {
    const uvec3 magnitudes = floatBitsToUint(coefficients[index]) & 0x7fffffffu;
    return magnitudes * uvec3(greaterThanEqual(magnitudes, uvec3(kLeastNormal)));
}

uint weightOf(uint index, uint magnitude) {
    const uint side = (1u << push.sideBits) - 1;
    const uint x = index & side, y = (index >> push.sideBits) & side;
    const uint fall = push.areaWeighted * (2 * uint(findMSB(x | y | 1)) << kExponent);
    return magnitude >= fall + kLeastNormal ? magnitude - fall : 0;
}

// Returns the largest |component| of all coefficients, and the largest weight. Fills `weights`.
uvec2 groupMaxima(uint lane) {
    uvec2 found = uvec2(0);
    for (uint i = lane; i < push.coefficients; i += kGroup) {
        const uint magnitude = largest(magnitudesOf(i)), weight = weightOf(i, magnitude);
        weights[i] = weight;
        found = max(found, uvec2(magnitude, weight));
    }
    partial[lane] = uvec3(found, 0);
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) partial[lane] = max(partial[lane], partial[lane + step]);
        barrier();
    }
    return partial[0].xy;
}

// Returns an entry's rank for selection: by weight, and of equals the one of lower index first.
uvec2 rankOf(uint index) { return uvec2(weights[index], push.coefficients - 1 - index); }

// Returns whether a rank is at least `least`.
bool isKept(uvec2 rank, uvec2 least) {
    return rank.x > least.x || (rank.x == least.x && rank.y >= least.y);
}

// Returns the rank of entry number push.count, found digit by digit from the highest: counts the entries that share
// the digits found so far, by their next digit.
const uint kDigitBits = 7; // 2^7 bins: one per lane
uvec2 selectByCount(uint lane) {
    uvec2 found = uvec2(0);
    uint remaining = push.count;
    for (uint word = 0; word < 2; word++)
        for (int shift = word == 0 ? 28 : 14; shift >= 0; shift -= int(kDigitBits)) {
            bins[lane] = 0;
            barrier();
            for (uint i = lane; i < push.coefficients; i += kGroup) {
                const uvec2 rank = rankOf(i);
                const uint value = rank[word];
                const bool follows = (word == 0 || rank.x == found.x) &&
                                     (value >> shift) >> kDigitBits == (found[word] >> shift) >> kDigitBits;
                if (follows) atomicAdd(bins[(value >> shift) & (kGroup - 1)], 1);
            }
            barrier();
            // Number of entries in this bin and all above.
            for (uint step = 1; step < kGroup; step *= 2) {
                const uint above = lane + step < kGroup ? bins[lane + step] : 0;
                barrier();
                bins[lane] += above;
                barrier();
            }
            const uint above = lane + 1 < kGroup ? bins[lane + 1] : 0;
            if (lane == 0) chosen = uvec2(0, remaining); // if there are fewer entries
            barrier();
            if (above < remaining && bins[lane] >= remaining) chosen = uvec2(lane, remaining - above);
            barrier();
            found[word] |= chosen.x << shift;
            remaining = chosen.y;
            barrier();
        }
    return found;
}

// Returns the exponent field of the smallest power of two of which `magnitude` is at most 32767 multiples: 14 below
// its own, or 13 if its mantissa is above that of 32767, 0x7ffe00.
uint stepExponent(uint magnitude) { return max((magnitude + 0x1ffu) >> kExponent, 15u) - 14u; }

float inverseOf(uint exponent) { return uintBitsToFloat((254u - exponent) << kExponent); }

// Returns magnitudes in units of the step; `inverse` is its reciprocal, a power of two.
vec3 placesOf(uint index, float inverse) { return uintBitsToFloat(magnitudesOf(index)) * inverse; }

// Rounds to nearest, halves away from zero. Floor and rest are exact.
uvec3 quantize(vec3 places) {
    const vec3 whole = floor(places);
    return uvec3(whole) + uvec3(greaterThanEqual(places - whole, vec3(0.5)));
}

// Returns the largest channel's sum of magnitudes over the kept coefficients.
uint groupMagnitude(uint lane, uvec2 least, float inverse) {
    uvec3 sum = uvec3(0);
    for (uint i = lane; i < push.coefficients; i += kGroup)
        if (isKept(rankOf(i), least)) sum += quantize(placesOf(i, inverse));
    barrier(); // all lanes have read the values before
    partial[lane] = sum;
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) partial[lane] += partial[lane + step];
        barrier();
    }
    return largest(partial[0]);
}

bool fits16(ivec3 value) { return all(lessThanEqual(abs(value), ivec3(32767))); }

// Adds counts of changes, either of which may be unknown.
uint addChange(uint a, uint b) { return max(a, b) == kUnknownChange ? kUnknownChange : a + b; }

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uvec2 maxima = groupMaxima(lane);
    uvec2 least;
    if (push.count > 0)
        least = selectByCount(lane);
    else
        least = uvec2(floatBitsToUint(uintBitsToFloat(maxima.y) * push.share), 0);
    if (least.x < kLeastNormal) least = uvec2(kLeastNormal, 0);
    uint exponent = stepExponent(maxima.x);
    while (groupMagnitude(lane, least, inverseOf(exponent)) > push.sumLimit) exponent++;

    const float inverse = inverseOf(exponent);
    const float scale = maxima.x > 0 ? uintBitsToFloat(exponent << kExponent) : 0;
    const bool isSameScale = stats.scale == scale;
    vec2 energy = vec2(0); // total, and lost
    uint kept = 0, changed = 0;
    for (uint i = lane; i < push.coefficients; i += kGroup) {
        const vec3 places = placesOf(i, inverse);
        uvec3 quantized = uvec3(0);
        if (isKept(rankOf(i), least)) quantized = quantize(places);
        const vec3 rest = places - vec3(quantized);
        energy += vec2(dot(places, places), dot(rest, rest));
        kept += uint(largest(quantized) > 0);
        const ivec3 value = ivec3(sign(coefficients[i])) * ivec3(quantized);
        const ivec3 change = value - unpackLight(table[i]);
        if (change != ivec3(0)) changed = addChange(changed, fits16(change) ? 1 : kUnknownChange);
        table[i] = packLight(value);
        table[push.coefficients + i] = packLight(change);
    }
    barrier();
    energies[lane] = energy;
    partial[lane].xy = uvec2(kept, changed);
    barrier();
    for (uint step = kGroup / 2; step > 0; step /= 2) {
        if (lane < step) {
            energies[lane] += energies[lane + step];
            partial[lane].x += partial[lane + step].x;
            partial[lane].y = addChange(partial[lane].y, partial[lane + step].y);
        }
        barrier();
    }
    if (lane == 0) {
        const uint change = isSameScale ? partial[0].y : kUnknownChange;
        stats = LightStats(scale, energies[0].x, energies[0].y, partial[0].x, change);
    }
}
