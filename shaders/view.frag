#version 460
// Reflected radiance: view maps of the worn layers, looked up in the local view direction, times the interpolated
// tuple. C++ twins: lookupMap() in engine/scene/factored_brdf.h, paintWeights() in engine/render/appearance.h. The
// sampler does the bilinear lookup, in three quarters of the time of four fetches on lavapipe; devices may round its
// weights to 8 bits, which the eye forgives and a bake would not.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/shared/render.h"

layout(constant_id = 0) const uint kTerms = 4;     // of this draw
layout(constant_id = 1) const bool kClamps = true; // this draw has all terms of its part
layout(constant_id = 2) const uint kLook = 0;
const uint kSurfaceSlots = kLook == kSurfaceLook ? 2 : 0;
const uint kUvSlot = kLook == kSurfaceLook ? kTerms : 0; // within the array even where nothing looks there
const uint kColorSlot = kLook == kSurfaceLook ? kTerms + 1 : 0;
layout(push_constant, scalar) uniform Push { ViewPush push; };
layout(binding = 2) uniform sampler2DArray viewMaps; // layer after layer of K maps
layout(binding = 3, scalar) readonly buffer Layers { ViewLayer layers[]; };
layout(binding = 4) uniform sampler2DArray baseColor;
layout(binding = 5) uniform sampler2DArray materialMap;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 slots[kTerms + kSurfaceSlots]; // the tuple, then (uv, r), (g, b, a)
layout(location = 0) out vec4 radiance;

// Of a layer's terms.
vec3 reflected(vec2 place, uint firstMap) {
    vec3 sum = vec3(0);
    for (uint k = 0; k < kTerms; k++)
        sum += texture(viewMaps, vec3(place, firstMap + push.firstTerm + k)).rgb * slots[k];
    return sum;
}

vec4 paintWeights(vec2 uv, vec4 color) {
    if (push.paint == kUnpainted) return vec4(0);
    vec4 paint = push.paint == kPaintedByMap ? texture(materialMap, vec3(uv, 0)) : color;
    for (uint m = push.materials; m < 4; m++) paint[m] = 0;
    const float sum = paint.x + paint.y + paint.z + paint.w;
    return sum > 0 ? paint / sum : vec4(1, 0, 0, 0);
}

vec3 reflectedBySurface(vec2 place) {
    const vec2 uv = slots[kUvSlot].xy;
    const vec4 paint = paintWeights(uv, vec4(slots[kUvSlot].z, slots[kColorSlot]));
    const vec3 base = texture(baseColor, vec3(uv, 0)).rgb;
    vec3 sum = vec3(0);
    for (uint i = 0; i < push.layers; i++) {
        vec3 weight = vec3(layers[i].weight);
        if (layers[i].channel >= 0) weight *= paint[layers[i].channel];
        if (layers[i].isTextured != 0) weight *= base;
        sum += weight * reflected(place, layers[i].firstMap);
    }
    return sum;
}

void main() {
    // Opposite normals can cancel out on a fold; any direction does there.
    const mat3 frame = tangentFrame(dot(normal, normal) < 1e-12 ? vec3(0, 1, 0) : normalize(normal));
    const vec3 local = liftAboveHorizon(frame * normalize(push.eye - position));
    const vec2 place = diskMapCoordinates(push.mapping, local);
    vec3 sum = vec3(0);
    if (kLook == kSingleLook)
        sum = push.weight * reflected(place, push.firstMap);
    else if (kLook == kLayersLook)
        for (uint i = 0; i < push.layers; i++) sum += layers[i].weight * reflected(place, layers[i].firstMap);
    else
        sum = reflectedBySurface(place);
    // A truncated sum of products can be negative.
    if (kClamps) sum = max(sum, 0);
    radiance = vec4(sum, 1);
}
