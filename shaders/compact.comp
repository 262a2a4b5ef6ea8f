#version 460
// Compacts the rows' entries that are not zero into one array, in order. One work-group per row.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bake.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { RowsPush push; };
layout(binding = 0, scalar) readonly buffer Selected { uint selected[]; };
layout(binding = 1, scalar) readonly buffer SelectedCounts { uint selectedCounts[]; };
layout(binding = 2, scalar) readonly buffer Values { uint values[]; };
layout(binding = 3, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 4, scalar) writeonly buffer Entries { uvec2 entries[]; }; // coefficient index, packed value

const uint kLanes = 32;
shared uint laneCounts[kLanes];

void main() {
    const uint lane = gl_LocalInvocationID.x, row = gl_WorkGroupID.x;
    const uint count = selectedCounts[row], firstPlace = row * push.kept;
    const uint run = (count + kLanes - 1) / kLanes;
    const uint begin = min(lane * run, count), end = min(begin + run, count);
    uint kept = 0;
    for (uint i = begin; i < end; i++) kept += uint(values[firstPlace + i] != 0);
    laneCounts[lane] = kept;
    barrier();
    uint place = starts[row];
    for (uint i = 0; i < lane; i++) place += laneCounts[i];
    for (uint i = begin; i < end; i++) {
        const uint value = values[firstPlace + i];
        if (value != 0) entries[place++] = uvec2(selected[firstPlace + i], value);
    }
}
