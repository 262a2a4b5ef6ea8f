#version 460
// Composites a view over the background. C++ twin: drawBackground() in engine/light/background.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/sky.glsl"
#include "shaders/shared/background.h"

layout(push_constant, scalar) uniform Push { BackgroundPush push; };
layout(binding = 0) uniform sampler2DArray view; // as large as the target; premultiplied by alpha
layout(binding = 1) uniform sampler2DArray map;  // latlong: engine/light/environment.h
layout(binding = 2, scalar) readonly buffer Light {
    LightSky sky;
    BackgroundDisc discs[];
};

layout(location = 0) out vec4 radiance;

const float kPi = 3.14159265358979;

vec3 mapRadiance(vec3 d) {
    const vec2 angles = vec2(atan(d.x, d.z) - push.rotation, atan(d.y, length(d.xz)));
    return textureLod(map, vec3(0.5 - angles.x / (2 * kPi), 0.5 - angles.y / kPi, 0), 0).rgb;
}

float coverage(BackgroundDisc disc, vec3 d) {
    const float outer = disc.outer + 0.5 * push.edge, inner = disc.inner - 0.5 * push.edge;
    return disc.amount * clamp((outer - distance(d, disc.center)) / (outer - inner), 0, 1);
}

vec3 radianceFrom(vec3 d) {
    vec3 sum = vec3(0);
    if (push.gain > 0) sum = push.gain * mapRadiance(d);
    if (push.hasSky != 0) sum += skyRadiance(sky, d);
    for (uint i = 0; i < push.strokes; i++) sum = mix(sum, discs[i].radiance, coverage(discs[i], d));
    return sum + coverage(discs[push.strokes], d) * discs[push.strokes].radiance;
}

void main() {
    const vec4 pixel = texelFetch(view, ivec3(gl_FragCoord.xy, 0), 0);
    vec3 sum = vec3(0);
    const uint lookups = pixel.a < 1 ? push.side * push.side : 0;
    for (uint i = 0; i < lookups; i++) {
        const vec2 place = gl_FragCoord.xy - 0.5 + (vec2(i % push.side, i / push.side) + 0.5) / float(push.side);
        sum += radianceFrom(normalize(push.corner + place.x * push.right + place.y * push.down));
    }
    radiance = vec4(pixel.rgb + (1 - min(pixel.a, 1)) * sum / float(max(lookups, 1)), 1);
}
