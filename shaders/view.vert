#version 460
// A vertex with its light-modulated tuple.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/render.h"

layout(constant_id = 0) const uint kTerms = 4; // of this draw
layout(constant_id = 2) const uint kLook = 0;
const uint kSurfaceSlots = kLook == kSurfaceLook ? 2 : 0;
const uint kUvSlot = kLook == kSurfaceLook ? kTerms : 0; // within the array even where nothing is written there
const uint kColorSlot = kLook == kSurfaceLook ? kTerms + 1 : 0;
layout(push_constant, scalar) uniform Push { ViewPush push; };
layout(binding = 0, scalar) readonly buffer Vertices { ViewVertex vertices[]; };
layout(binding = 1, scalar) readonly buffer Tuples { vec3 tuples[]; };

// A part with more terms than a draw holds is drawn again where its depth is equal.
invariant gl_Position;
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
// The tuple, and where the surface is looked at (uv, r), (g, b, a), in as few varyings as serve: each costs time.
layout(location = 2) out vec3 slots[kTerms + kSurfaceSlots];

void main() {
    const ViewVertex vertex = vertices[gl_VertexIndex];
    position = vertex.position;
    normal = vertex.normal;
    if (kLook == kSurfaceLook) {
        slots[kUvSlot] = vec3(vertex.uv, vertex.color.r);
        slots[kColorSlot] = vertex.color.gba;
    }
    gl_Position = push.clipFromWorld * vec4(vertex.position, 1);

    const uint firstRow = gl_VertexIndex * push.terms + push.firstTerm;
    for (uint k = 0; k < kTerms; k++) slots[k] = tuples[firstRow + k];
}
