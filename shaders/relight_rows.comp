#version 460
// Computes tuples as transport times light: an invocation per row, that is, per vertex and term. Sums are exact, so
// that their order does not matter.
// C++ twin: relight() in precompute/twins/relight_twin.h. Layout: engine/transport/rows/rows_relighter.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_packing.glsl"
#include "shaders/lib/packing.glsl"
#include "shaders/shared/render.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { RelightRowsPush push; };
layout(binding = 0, std430) readonly buffer Starts { uint starts[]; };
layout(binding = 1, std430) readonly buffer Entries { uvec4 entries[]; };
layout(binding = 2, scalar) readonly buffer Table { PackedLight table[]; };
layout(binding = 3, scalar) readonly buffer Light { LightStats light; };
layout(binding = 4, scalar) readonly buffer RowScales { float rowScales[]; };
layout(binding = 5, scalar) writeonly buffer Tuples { vec3 tuples[]; };

ivec3 product(uint index, uint value) { return unpackCoefficient(value) * unpackLight(table[index]); }

void main() {
    const uint row = gl_GlobalInvocationID.x;
    if (row >= push.rows) return;
    ivec3 sum = ivec3(0);
    const uint end = starts[row + 1];
    // Eight entries take three loads: on software devices the cost is per load, not per byte.
    for (uint group = starts[row]; group < end; group++) {
        const uvec4 indices = entries[3 * group];
        const uvec4 first = entries[3 * group + 1], second = entries[3 * group + 2];
        sum += product(indices.x & 0xffff, first.x) + product(indices.x >> 16, first.y) +
               product(indices.y & 0xffff, first.z) + product(indices.y >> 16, first.w) +
               product(indices.z & 0xffff, second.x) + product(indices.z >> 16, second.y) +
               product(indices.w & 0xffff, second.z) + product(indices.w >> 16, second.w);
    }
    precise const vec3 tuple =
        vec3(sum) * (light.scale * rowScales[push.firstRow + row]) * kCoefficientUnit;
    tuples[push.firstRow + row] = tuple;
}
