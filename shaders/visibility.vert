#version 460
// Rasterizes the occluder into one cube face of one point; the instance gives the layer.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "shaders/lib/visibility_clip.glsl"
#include "shaders/shared/bake.h"

layout(push_constant, scalar) uniform Push { VisibilityPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Positions { vec3 positions[]; };
layout(binding = 2, scalar) readonly buffer Layers { uint instanceLayers[]; };

invariant gl_Position; // visibility.vert and visibility_face.vert must give the same bits

void main() {
    const uint layer = instanceLayers[gl_InstanceIndex];
    gl_Position = visibilityClip(positions[gl_VertexIndex], points[layer / 6], layer % 6, push);
    gl_Layer = int(layer);
}
