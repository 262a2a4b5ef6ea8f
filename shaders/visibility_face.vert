#version 460
// Rasterizes the occluder into the cube face of one point that the push constant gives, for devices whose vertex
// shaders cannot choose a layer.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/visibility_clip.glsl"
#include "shaders/shared/bake.h"

layout(push_constant, scalar) uniform Push { VisibilityPush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, scalar) readonly buffer Positions { vec3 positions[]; };

invariant gl_Position; // visibility.vert and visibility_face.vert must give the same bits

void main() {
    gl_Position = visibilityClip(positions[gl_VertexIndex], points[push.layer / 6], push.layer % 6, push);
}
