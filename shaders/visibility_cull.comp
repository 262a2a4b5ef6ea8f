#version 460
// Decides which clusters of the occluder are drawn into which cube faces. A cluster is left out if its bounding box
// is wholly below the point's horizon, behind the face, or outside the face's pyramid, or if it is part of a closed
// surface and shows the point front faces only.
// The order of instances is not deterministic, but the image is: every triangle writes the same value.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/bake.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kCull = true; // false: every cluster is drawn into every face
// True: all layers are drawn at once, with a draw per cluster and an instance per layer that it is visible in. False:
// layers are drawn one by one, with a draw per layer and cluster.
layout(constant_id = 1) const bool kLayered = true;
layout(push_constant, scalar) uniform Push { CullPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Clusters { TriangleCluster clusters[]; };
// VkDrawIndexedIndirectCommand: index count, instance count, first index, vertex offset, first instance.
layout(binding = 2, scalar) buffer Draws { uint draws[][5]; };
layout(binding = 3, scalar) writeonly buffer Layers { uint instanceLayers[]; };

bool canShow(BakePoint point, TriangleCluster cluster, uint face) {
    const vec3 center = cluster.center - point.origin;
    const vec3 extent = cluster.extent + 1e-6 * (abs(center) + cluster.extent); // a margin for rounding
    if (dot(point.normal, center) + dot(abs(point.normal), extent) <= 0) return false;
    if (dot(normalize(cluster.apex - point.origin), cluster.axis) >= cluster.cutoff) return false;
    // Face coordinates: the pyramid is |x| ≤ z, |y| ≤ z.
    const vec3 local = center * kFaceAxes[face], reach = abs(extent * kFaceAxes[face]);
    return local.z + reach.z > 0 && abs(local.x) - local.z <= reach.x + reach.z &&
           abs(local.y) - local.z <= reach.y + reach.z;
}

void main() {
    const uint layer = gl_GlobalInvocationID.x, cluster = gl_GlobalInvocationID.y;
    if (layer >= push.layers) return;
    const bool isDrawn = !kCull || canShow(points[layer / 6], clusters[cluster], layer % 6);
    if (!kLayered)
        draws[layer * push.clusters + cluster] =
            uint[5](clusters[cluster].indexCount, isDrawn ? 1 : 0, clusters[cluster].firstIndex, 0, 0);
    if (!kLayered || !isDrawn) return;
    const uint slot = atomicAdd(draws[cluster][1], 1);
    instanceLayers[cluster * push.layers + slot] = layer;
}
