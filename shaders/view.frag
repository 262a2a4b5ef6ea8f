#version 460
// Reflected radiance: view maps, looked up in the local view direction, times the interpolated tuple.
// C++ twin, up to the tuple: lookupMap() in engine/scene/factored_brdf.h. The sampler does the bilinear lookup, in
// three quarters of the time of four fetches on lavapipe; devices may round its weights to 8 bits, which the eye
// forgives and a bake would not.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/shared/render.h"

layout(constant_id = 0) const uint kTerms = 4;     // of this draw
layout(constant_id = 1) const bool kClamps = true; // this draw has all terms of its part
layout(push_constant, scalar) uniform Push { ViewPush push; };
layout(binding = 4) uniform sampler2DArray viewMaps;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tuple[kTerms];
layout(location = 0) out vec4 color;

void main() {
    // Opposite normals can cancel out on a fold; any direction does there.
    const mat3 frame = tangentFrame(dot(normal, normal) < 1e-12 ? vec3(0, 1, 0) : normalize(normal));
    const vec3 local = liftAboveHorizon(frame * normalize(push.eye - position));
    const vec2 place = diskMapCoordinates(push.mapping, local);
    vec3 radiance = vec3(0);
    for (uint k = 0; k < kTerms; k++)
        radiance += texture(viewMaps, vec3(place, push.firstTerm + k)).rgb * tuple[k];
    // A truncated sum of products can be negative.
    if (kClamps) radiance = max(radiance, 0);
    color = vec4(radiance, 1);
}
