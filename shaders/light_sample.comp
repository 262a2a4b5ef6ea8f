#version 460
// Mean radiance of each texel of the lighting cube, from a prepared latitude-longitude map.
// C++ twin: sampleEnvironment() in engine/light/light_cube.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/angle.glsl"
#include "shaders/lib/cubemap.glsl"
#include "shaders/shared/render.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kSize = 64;
layout(push_constant, scalar) uniform Push { LightSamplePush push; };
layout(binding = 0, scalar) readonly buffer Environment { vec3 environment[]; };
layout(binding = 1, scalar) writeonly buffer Radiance { vec3 radiance[]; };

const float kPi = 3.14159265358979;

// Bilinear, wrapping in longitude.
vec3 lookup(vec3 direction) {
    const ivec2 size = ivec2(push.width, push.height);
    const float longitude = angleOf(direction.x, direction.z);
    const float latitude = angleOf(direction.y, length(direction.xz));
    const vec2 place = vec2(0.5 - longitude / (2 * kPi), 0.5 - latitude / kPi) * vec2(size) - 0.5;
    const vec2 corner = floor(place);
    const vec2 weight = place - corner;
    // place.x lies in [-1/2, width - 1/2].
    const int x0 = corner.x < 0 ? size.x - 1 : int(corner.x), x1 = x0 + 1 == size.x ? 0 : x0 + 1;
    const int y0 = clamp(int(corner.y), 0, size.y - 1), y1 = clamp(int(corner.y) + 1, 0, size.y - 1);
    const vec3 upper = mix(environment[y0 * size.x + x0], environment[y0 * size.x + x1], weight.x);
    const vec3 lower = mix(environment[y1 * size.x + x0], environment[y1 * size.x + x1], weight.x);
    return mix(upper, lower, weight.y);
}

void main() {
    const uint texel = gl_GlobalInvocationID.x;
    if (texel >= 6 * kSize * kSize) return;
    const uint face = texel / (kSize * kSize);
    const vec2 corner = vec2(texel % kSize, texel / kSize % kSize);
    // Face coordinates to the map's: the face's axes, turned.
    const mat3 turn = mat3(push.cosine, 0, push.sine, 0, 1, 0, -push.sine, 0, push.cosine);
    const mat3 axes = turn * kFaceAxes[face];

    vec3 sum = vec3(0);
    float weights = 0;
    for (uint j = 0; j < push.samples; j++)
        for (uint i = 0; i < push.samples; i++) {
            const vec2 uv = 2 * (corner + (vec2(i, j) + 0.5) / float(push.samples)) / float(kSize) - 1;
            const float weight = cubeSolidAngle(uv, 1);
            sum += weight * lookup(axes * vec3(uv, 1));
            weights += weight;
        }
    radiance[texel] = sum / weights;
}
