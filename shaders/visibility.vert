#version 460
// Rasterises the occluder into one cube face of one point; the instance says which layer.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/bake.h"

layout(push_constant, scalar) uniform Push { VisibilityPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Positions { vec3 positions[]; };
layout(binding = 2, scalar) readonly buffer Layers { uint instanceLayers[]; };

void main() {
    const uint layer = instanceLayers[gl_InstanceIndex];
    const vec3 local = (positions[gl_VertexIndex] - points[layer / 6].origin) * kFaceAxes[layer % 6];
    // Depth is not stored; z only clips at the near plane, since 0 ≤ z ≤ w where z = w - near.
    gl_Position = vec4(local.xy, local.z - push.nearDistance, local.z);
    gl_Layer = int(layer);
}
