#version 460
// The light on the basis vectors of clusters: exact sums, times the light's scale. A subgroup a cluster and 64 of its
// components. It lists the columns that the light meets, and reads no others: two words of four components a lane, so
// that larger subgroups read several columns at a time.
// C++ twin: relight() in precompute/reference/relight_twin.h. Layout: engine/render/bases_relighter.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shaders/lib/light_packing.glsl"
#include "shaders/shared/render.h"

layout(local_size_x_id = 0) in; // the device's subgroup size, a multiple of 8
layout(binding = 0, scalar) readonly buffer Groups { BasisGroup groups[]; };
layout(binding = 1, std430) readonly buffer Indices { uint indices[]; }; // two columns a word
layout(binding = 2, std430) readonly buffer Basis { uint basis[]; };     // column after column
layout(binding = 3, scalar) readonly buffer Table { PackedLight table[]; };
layout(binding = 4, scalar) readonly buffer Light { LightStats light; };
layout(binding = 5, scalar) writeonly buffer Projections { vec3 projections[]; };

const uint kLanes = gl_WorkGroupSize.x;
const uint kWords = 8; // of a column, that a group reads at a time
const uint kStreams = kLanes / kWords;
const uint kListed = 64;

shared uint listedColumns[kListed];
shared ivec3 listedLights[kListed];
shared ivec3 streamSums[kLanes * 8];

uint columnIndex(uint column) { return indices[column / 2] >> (column % 2 * 16) & 0xffff; }

#define ADD(word, first)                                                                                              \
    sums[first] += bitfieldExtract(word, 0, 8) * value;                                                               \
    sums[first + 1] += bitfieldExtract(word, 8, 8) * value;                                                           \
    sums[first + 2] += bitfieldExtract(word, 16, 8) * value;                                                          \
    sums[first + 3] += (word >> 24) * value;

#define STORE(component, first)                                                                                       \
    projections[component] = vec3(sums[first]) * light.scale;                                                         \
    projections[component + 1] = vec3(sums[first + 1]) * light.scale;                                                 \
    projections[component + 2] = vec3(sums[first + 2]) * light.scale;                                                 \
    projections[component + 3] = vec3(sums[first + 3]) * light.scale;

void main() {
    const BasisGroup group = groups[gl_WorkGroupID.x];
    const uint lane = gl_LocalInvocationID.x;
    const uint word = lane % kWords, stream = lane / kWords;
    // A second word of the same columns: listing these again would cost more.
    const bool hasWord = group.firstWord + word < group.wordsPerColumn;
    const bool hasSecond = group.firstWord + word + kWords < group.wordsPerColumn;
    const uint end = group.firstColumn + group.columns;
    ivec3 sums[8] = ivec3[](ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0), ivec3(0));
    uint listed = 0;
    for (uint first = group.firstColumn; first < end; first += kLanes) {
        const uint column = first + lane;
        ivec3 meets = ivec3(0);
        if (column < end) meets = unpackLight(table[columnIndex(column)]);
        const bool isMet = meets != ivec3(0);
        const uvec4 met = subgroupBallot(isMet);
        if (isMet) {
            const uint place = listed + subgroupBallotExclusiveBitCount(met);
            listedColumns[place] = column - group.firstColumn;
            listedLights[place] = meets;
        }
        listed += subgroupBallotBitCount(met);
        if (listed + kLanes <= kListed && first + kLanes < end) continue;
        barrier();
        for (uint i = stream; i < listed && hasWord; i += kStreams) {
            const uint place =
                group.firstBasisWord + listedColumns[i] * group.wordsPerColumn + group.firstWord + word;
            const ivec3 value = listedLights[i];
            const int four = int(basis[place]);
            ADD(four, 0)
            if (hasSecond) {
                const int more = int(basis[place + kWords]);
                ADD(more, 4)
            }
        }
        barrier();
        listed = 0;
    }
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
