#version 460
// Tuples of transport times light where the vertices of a cluster share their coefficient sets. A subgroup a
// cluster and term. It lists the columns that the light meets, and reads no others: 32 words each, four a lane, so
// that larger subgroups read several columns at a time.
// C++ twin: relight() in precompute/reference/relight_twin.h. Layout: engine/transport/clustered_transport.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shaders/lib/light_packing.glsl"
#include "shaders/lib/packing.glsl"
#include "shaders/shared/render.h"

layout(local_size_x_id = 0) in; // the device's subgroup size, a multiple of 8
layout(push_constant, scalar) uniform Push { RelightClustersPush push; };
layout(binding = 0, std430) readonly buffer Starts { uint starts[]; };
layout(binding = 1, std430) readonly buffer Indices { uint indices[]; }; // two columns a word
layout(binding = 2, std430) readonly buffer Columns { uvec4 columns[]; };
layout(binding = 3, scalar) readonly buffer Table { PackedLight table[]; };
layout(binding = 4, scalar) readonly buffer Light { LightStats light; };
layout(binding = 5, scalar) readonly buffer RowScales { float rowScales[]; };
layout(binding = 6, scalar) writeonly buffer Tuples { vec3 tuples[]; };

const uint kLanes = gl_WorkGroupSize.x;
const uint kQuads = 8; // of vertices
const uint kStreams = kLanes / kQuads;
const uint kListed = 64;

shared uint listedColumns[kListed];
shared ivec3 listedLights[kListed];
shared ivec3 streamSums[kLanes * 4];

uint columnIndex(uint column) { return indices[column / 2] >> (column % 2 * 16) & 0xffff; }

void main() {
    const uint group = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    const uint quad = lane % kQuads, stream = lane / kQuads;
    const uint end = starts[group + 1];
    ivec3 sums[4] = ivec3[](ivec3(0), ivec3(0), ivec3(0), ivec3(0));
    uint listed = 0;
    for (uint first = starts[group]; first < end; first += kLanes) {
        const uint column = first + lane;
        ivec3 meets = ivec3(0);
        if (column < end) meets = unpackLight(table[columnIndex(column)]);
        const bool isMet = meets != ivec3(0);
        const uvec4 met = subgroupBallot(isMet);
        if (isMet) {
            const uint place = listed + subgroupBallotExclusiveBitCount(met);
            listedColumns[place] = column;
            listedLights[place] = meets;
        }
        listed += subgroupBallotBitCount(met);
        if (listed + kLanes <= kListed && first + kLanes < end) continue;
        barrier();
        for (uint i = stream; i < listed; i += kStreams) {
            const uvec4 words = columns[listedColumns[i] * kQuads + quad];
            const ivec3 value = listedLights[i];
            sums[0] += unpackCoefficient(words.x) * value;
            sums[1] += unpackCoefficient(words.y) * value;
            sums[2] += unpackCoefficient(words.z) * value;
            sums[3] += unpackCoefficient(words.w) * value;
        }
        barrier();
        listed = 0;
    }
    if (kStreams > 1) {
        for (uint i = 0; i < 4; i++) streamSums[lane * 4 + i] = sums[i];
        barrier();
        if (stream > 0) return;
        for (uint other = 1; other < kStreams; other++)
            for (uint i = 0; i < 4; i++) sums[i] += streamSums[(other * kQuads + quad) * 4 + i];
    }
    const uint place = push.firstGroup + group;
    const uint vertex = place / push.terms * 4 * kQuads + 4 * quad, term = place % push.terms;
    for (uint i = 0; i < 4 && vertex + i < push.vertices; i++) {
        const uint row = (vertex + i) * push.terms + term;
        precise const vec3 tuple = vec3(sums[i]) * (light.scale * rowScales[row]) * kCoefficientUnit;
        tuples[row] = tuple;
    }
}
