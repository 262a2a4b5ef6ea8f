#version 460
// Computes where each row's entries start when compacted: an exclusive prefix sum of their counts. One work-group.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bake.h"

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { RowsPush push; };
layout(binding = 0, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 1, scalar) writeonly buffer Starts { uint starts[]; };

const uint kLanes = 256;
shared uint laneSums[kLanes];

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint run = (push.rows + kLanes - 1) / kLanes;
    const uint begin = min(lane * run, push.rows), end = min(begin + run, push.rows);
    uint sum = 0;
    for (uint row = begin; row < end; row++) sum += counts[row];
    laneSums[lane] = sum;
    barrier();
    uint start = 0;
    for (uint i = 0; i < lane; i++) start += laneSums[i];
    for (uint row = begin; row < end; row++) {
        starts[row] = start;
        start += counts[row];
    }
}
