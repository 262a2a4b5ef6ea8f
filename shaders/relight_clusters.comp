#version 460
// Tuples of transport times light where the vertices of a cluster share their coefficient sets. A subgroup a
// cluster and term. It reads the columns that the light, or its change, meets: 32 words each, four a lane, so that
// larger subgroups read several columns at a time. Sums are integers: those changed any number of times are those
// made anew.
// C++ twin: relight() in precompute/reference/relight_twin.h. Layout: engine/transport/clustered_transport.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/column_list.glsl"
#include "shaders/lib/packing.glsl"

layout(push_constant, scalar) uniform Push { RelightClustersPush push; };
layout(binding = 3, std430) readonly buffer Starts { uint starts[]; };
layout(binding = 4, std430) readonly buffer Columns { uvec4 columns[]; };
layout(binding = 5, scalar) readonly buffer RowScales { float rowScales[]; };
layout(binding = 6, scalar) buffer Sums { ivec3 rowSums[]; };
layout(binding = 7, scalar) writeonly buffer Tuples { vec3 tuples[]; };

const uint kLanes = gl_WorkGroupSize.x;
const uint kQuads = 8; // of vertices
const uint kStreams = kLanes / kQuads;

shared ivec3 streamSums[kLanes * 4];

void main() {
    const uint group = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    const uint quad = lane % kQuads, stream = lane / kQuads;
    const uint end = starts[group + 1];
    const bool replaces = replacesSums(light, push.mode);
    ivec3 sums[4] = ivec3[](ivec3(0), ivec3(0), ivec3(0), ivec3(0));
    uint met = 0;
    for (uint next = starts[group]; next < end;) {
        const uint listed = listColumns(next, end, replaces);
        for (uint i = stream; i < listed; i += kStreams) {
            const uvec4 words = columns[listedColumns[i] * kQuads + quad];
            const ivec3 value = listedLights[i];
            sums[0] += unpackCoefficient(words.x) * value;
            sums[1] += unpackCoefficient(words.y) * value;
            sums[2] += unpackCoefficient(words.z) * value;
            sums[3] += unpackCoefficient(words.w) * value;
        }
        barrier();
        met += listed;
    }
    if (met == 0 && !replaces) return;
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
        if (!replaces) sums[i] += rowSums[row];
        rowSums[row] = sums[i];
        precise const vec3 tuple = vec3(sums[i]) * (light.scale * rowScales[row]) * kCoefficientUnit;
        tuples[row] = tuple;
    }
}
