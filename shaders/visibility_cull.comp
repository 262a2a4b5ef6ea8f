#version 460
// Decides which clusters of the occluder are drawn into which cube faces: a cluster is left out when its
// bounding sphere lies wholly below the point's horizon, behind the face, or outside the face's pyramid.
// The order of instances is not deterministic, but the image is: every triangle writes the same value.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/bake.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kCull = true; // false: every cluster is drawn into every face
// All layers are drawn at once, a draw a cluster, an instance a layer that it shows in. False: one by one, a
// draw a layer and cluster.
layout(constant_id = 1) const bool kLayered = true;
layout(push_constant, scalar) uniform Push { CullPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Clusters { TriangleCluster clusters[]; };
// VkDrawIndexedIndirectCommand: index count, instance count, first index, vertex offset, first instance.
layout(binding = 2, scalar) buffer Draws { uint draws[][5]; };
layout(binding = 3, scalar) writeonly buffer Layers { uint instanceLayers[]; };

bool canShow(BakePoint point, TriangleCluster sphere, uint face) {
    const vec3 centre = sphere.centre - point.origin;
    if (dot(centre, point.normal) < -sphere.radius) return false;
    // Face coordinates: the pyramid is |x| ≤ z, |y| ≤ z; its side planes have normals (±1, 0, 1) / √2.
    const vec3 local = centre * kFaceAxes[face];
    const float reach = sphere.radius * 1.41421357;
    return local.z >= -sphere.radius && abs(local.x) - local.z <= reach && abs(local.y) - local.z <= reach;
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
