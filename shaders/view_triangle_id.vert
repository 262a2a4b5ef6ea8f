#version 460
// Transforms positions of the visibility buffer. A triangle's first vertex gives its id: positions are numbered so
// (engine/render/numbered_triangles.h).
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/render.h"

layout(push_constant, scalar) uniform Push { ViewTriangleIdPush push; };
layout(location = 0) in vec3 position;
layout(location = 0) flat out uint triangleId;

void main() {
    triangleId = push.firstTriangleId + gl_VertexIndex;
    gl_Position = push.clipFromWorld * vec4(position, 1);
}
