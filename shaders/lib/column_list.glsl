// Lists the columns of a cluster that a light meets, so that a group reads no others. For kernels of a subgroup a
// group, in PORTABLE shaders of up to 32 invocations; they have their size and bindings 0 to 2 from here.
#ifndef RELUME_LIB_COLUMN_LIST_GLSL
#define RELUME_LIB_COLUMN_LIST_GLSL
#ifndef PORTABLE
#extension GL_KHR_shader_subgroup_ballot : require
#endif
#include "shaders/lib/light_packing.glsl"
#include "shaders/shared/render.h"

layout(local_size_x_id = 0) in; // a multiple of 8
layout(binding = 0, std430) readonly buffer Indices { uint indices[]; };    // two columns a word
layout(binding = 1, scalar) readonly buffer Table { PackedLight table[]; }; // the light, then how it changed
layout(binding = 2, scalar) readonly buffer Light { LightStats light; };

const uint kListed = 64;
shared uint listedColumns[kListed];
shared ivec3 listedLights[kListed];

#ifdef PORTABLE
shared uint gMet; // a bit an invocation

uvec4 ballot(bool isMet) {
    if (gl_LocalInvocationID.x == 0) gMet = 0;
    barrier();
    if (isMet) atomicOr(gMet, 1u << gl_LocalInvocationID.x);
    barrier();
    const uint met = gMet;
    barrier(); // before it is cleared again
    return uvec4(met, 0, 0, 0);
}
uint countBelow(uvec4 met) { return bitCount(met.x & (1u << gl_LocalInvocationID.x) - 1); }
uint countOf(uvec4 met) { return bitCount(met.x); }
#else
uvec4 ballot(bool isMet) { return subgroupBallot(isMet); }
uint countBelow(uvec4 met) { return subgroupBallotExclusiveBitCount(met); }
uint countOf(uvec4 met) { return subgroupBallotBitCount(met); }
#endif

uint columnIndex(uint column) { return indices[column / 2] >> (column % 2 * 16) & 0xffff; }

// Lists columns of [next, end) until there are no more or the list may be full, and moves `next` behind those it has
// looked at. Returns how many are listed; callers go through them between this and a barrier.
uint listColumns(inout uint next, uint end, bool replaces) {
    const uint lanes = gl_WorkGroupSize.x;
    const uint firstEntry = replaces ? 0 : uint(table.length()) / 2;
    uint listed = 0;
    do {
        const uint column = next + gl_LocalInvocationID.x;
        ivec3 meets = ivec3(0);
        if (column < end) meets = unpackLight(table[firstEntry + columnIndex(column)]);
        const bool isMet = meets != ivec3(0);
        const uvec4 met = ballot(isMet);
        if (isMet) {
            const uint place = listed + countBelow(met);
            listedColumns[place] = column;
            listedLights[place] = meets;
        }
        listed += countOf(met);
        next += lanes;
    } while (next < end && listed + lanes <= kListed);
    barrier();
    return listed;
}

#endif
