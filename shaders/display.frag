#version 460
// Tone-maps a linear image, over a uniform background. C++ twin: toneMap() in engine/render/tone_map.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/tone_map.glsl"
#include "shaders/shared/render.h"

layout(constant_id = 0) const uint kCurve = 0;
layout(push_constant, scalar) uniform Push { DisplayPush push; };
layout(binding = 0) uniform sampler2DArray image; // as large as the target

layout(location = 0) out vec4 display;

void main() {
    const vec4 pixel = texelFetch(image, ivec3(gl_FragCoord.xy, 0), 0);
    display = vec4(pixel.a == 0 ? push.background : toneMap(pixel.rgb, kCurve, push.scale), 1);
}
