#version 460
// Resets every cluster's indirect draw to no instances.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bake.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CullPush push; };
layout(binding = 0, scalar) readonly buffer Clusters { TriangleCluster clusters[]; };
layout(binding = 1, scalar) writeonly buffer Draws { uint draws[][5]; };

void main() {
    const uint cluster = gl_GlobalInvocationID.x;
    if (cluster >= push.clusters) return;
    draws[cluster] = uint[5](clusters[cluster].indexCount, 0, clusters[cluster].firstIndex, 0,
                             cluster * push.layers);
}
