#version 460
// Projects the light onto the basis vectors of clusters: exact sums, times the light's scale. A subgroup handles 64
// components of a cluster. It reads only the columns at which the light, or its change, is not zero, with two words
// of four components per lane, so that larger subgroups read several columns at a time. Since sums are integers,
// updating them any number of times gives the same as summing anew.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#ifndef PORTABLE
#extension GL_KHR_shader_subgroup_ballot : require
#endif
#include "shaders/lib/light_packing.glsl"
#include "shaders/shared/render.h"

layout(local_size_x_id = 0) in; // a multiple of 8
layout(binding = 0, std430) readonly buffer Indices { uint indices[]; }; // two columns per word
layout(binding = 1, scalar) readonly buffer Table { PackedLight table[]; }; // the light's entries, then their changes
layout(binding = 2, scalar) readonly buffer Light { LightStats light; };

const uint kListed = 64;
shared uint listedColumns[kListed];
shared ivec3 listedLights[kListed];

#ifdef PORTABLE
shared uint gMet; // a bit per invocation, of which there are at most 32

uvec4 ballot(bool isMet) {
    if (gl_LocalInvocationID.x == 0) gMet = 0;
    barrier();
    if (isMet) atomicOr(gMet, 1u << gl_LocalInvocationID.x);
    barrier();
    const uint met = gMet;
    barrier(); // before gMet is cleared again
    return uvec4(met, 0, 0, 0);
}
uint countBelow(uvec4 met) { return bitCount(met.x & (1u << gl_LocalInvocationID.x) - 1); }
uint countOf(uvec4 met) { return bitCount(met.x); }
#else
uvec4 ballot(bool isMet) { return subgroupBallot(isMet); }
uint countBelow(uvec4 met) { return subgroupBallotExclusiveBitCount(met); }
uint countOf(uvec4 met) { return subgroupBallotBitCount(met); }
#endif

const uint kLanes = gl_WorkGroupSize.x;

// Lists the active columns in [next, end), at which the light is not zero, until there are no more or the list may be
// full; moves `next` past those examined. Returns how many are listed; callers use the list before the next barrier.
uint listColumns(inout uint next, uint end, bool replaces) {
    const uint firstEntry = replaces ? 0 : uint(table.length()) / 2;
    uint listed = 0;
    do {
        const uint column = next + gl_LocalInvocationID.x;
        ivec3 meets = ivec3(0);
        if (column < end) {
            const uint index = indices[column / 2] >> (column % 2 * 16) & 0xffff;
            meets = unpackLight(table[firstEntry + index]);
        }
        const bool isMet = meets != ivec3(0);
        const uvec4 met = ballot(isMet);
        if (isMet) {
            const uint place = listed + countBelow(met);
            listedColumns[place] = column;
            listedLights[place] = meets;
        }
        listed += countOf(met);
        next += kLanes;
    } while (next < end && listed + kLanes <= kListed);
    barrier();
    return listed;
}

layout(push_constant, scalar) uniform Push { RelightProjectPush push; };
layout(binding = 3, scalar) readonly buffer Groups { BasisGroup groups[]; };
layout(binding = 4, std430) readonly buffer Basis { uint basis[]; }; // column after column
layout(binding = 5, scalar) buffer Sums { ivec3 componentSums[]; };
layout(binding = 6, scalar) writeonly buffer Projections { vec4 projections[]; };
layout(binding = 7, std430) writeonly buffer Stamps { uint stamps[]; }; // per cluster: the last recording that changed it

const uint kWords = 8; // words of a column that a work-group reads at a time
const uint kStreams = kLanes / kWords;

shared ivec3 streamSums[kLanes * 8];

#define ADD(word, first)                                                                                              \
    sums[first] += bitfieldExtract(word, 0, 8) * value;                                                               \
    sums[first + 1] += bitfieldExtract(word, 8, 8) * value;                                                           \
    sums[first + 2] += bitfieldExtract(word, 16, 8) * value;                                                          \
    sums[first + 3] += (word >> 24) * value;

// Stores sums [first, first + 4) as those of the components from `component` on.
#define STORE(component, first)                                                                                       \
    for (uint i = 0; i < 4; i++) {                                                                                    \
        if (!replaces) sums[first + i] += componentSums[component + i];                                               \
        componentSums[component + i] = sums[first + i];                                                               \
        projections[component + i] = vec4(vec3(sums[first + i]) * light.scale, 0);                                    \
    }

void main() {
    const BasisGroup group = groups[gl_WorkGroupID.x];
    const uint lane = gl_LocalInvocationID.x;
    const uint word = lane % kWords, stream = lane / kWords;
    // A lane also reads a second word of the same columns: listing these again would cost more.
    const bool hasWord = group.firstWord + word < group.wordsPerColumn;
    const bool hasSecond = group.firstWord + word + kWords < group.wordsPerColumn;
    const uint end = group.firstColumn + group.columns;
    ivec3 sums[8] = ivec3[](ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0));
    const bool replaces = replacesSums(light, push.mode);
    uint met = 0;
    for (uint next = group.firstColumn; next < end;) {
        const uint listed = listColumns(next, end, replaces);
        for (uint i = stream; i < listed && hasWord; i += kStreams) {
            const uint column = listedColumns[i] - group.firstColumn;
            const uint place = group.firstBasisWord + column * group.wordsPerColumn + group.firstWord + word;
            const ivec3 value = listedLights[i];
            const int four = int(basis[place]);
            ADD(four, 0)
            if (hasSecond) {
                const int more = int(basis[place + kWords]);
                ADD(more, 4)
            }
        }
        barrier();
        met += listed;
    }
    if (met == 0 && !replaces) return;
    if (lane == 0) stamps[group.cluster] = push.stamp;
    if (kStreams > 1) {
        for (uint i = 0; i < 8; i++) streamSums[lane * 8 + i] = sums[i];
        barrier();
        if (stream > 0) return;
        for (uint other = 1; other < kStreams; other++)
            for (uint i = 0; i < 8; i++) sums[i] += streamSums[(other * kWords + word) * 8 + i];
    }
    if (!hasWord) return;
    const uint component = group.firstComponent + 4 * (group.firstWord + word);
    STORE(component, 0)
    if (hasSecond) {
        STORE(component + 4 * kWords, 4)
    }
}
