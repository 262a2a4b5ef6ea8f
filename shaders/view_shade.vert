#version 460
// Draws the rectangle of pixels that a part may cover.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/render.h"

layout(push_constant, scalar) uniform Push { ViewRays rays; };

void main() {
    const uint corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2; // 0 1 2, 1 2 3
    gl_Position = vec4(mix(rays.rectangle.xy, rays.rectangle.zw, vec2(corner & 1, corner >> 1)), 0, 1);
}
