#version 460
// Sums the unshadowed tuples of all normals: polar maps about +Y, four terms per invocation.
// C++ twin: unshadowedTuples() in precompute/twins/lit_sphere_twin.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/disk_map.glsl"
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 16) in;
layout(push_constant, scalar) uniform Push { UnshadowedTuplesPush push; };
TEXELS(0, vec4, samplerBuffer, Lights, lights);           // direction, and radiance · solid angle
layout(binding = 1) uniform sampler2DArray lightMaps;     // packed as ViewMapTexture is
layout(binding = 2, std430) writeonly buffer Tuples { vec4 tuples[]; }; // [image][row][azimuth]

void main() {
    const uint azimuth = gl_GlobalInvocationID.x, row = gl_GlobalInvocationID.y, quad = gl_GlobalInvocationID.z;
    if (azimuth >= kTupleAzimuths) return;
    const uint side = push.isTurned != 0 ? row / (kTupleTurns * kTupleSideRings) : 0;
    const uint ring = push.isTurned != 0 ? row % kTupleSideRings + side * (kTupleRings - kTupleSideRings) : row;
    const uint turn = push.isTurned != 0 ? row / kTupleSideRings % kTupleTurns : 0;
    const vec3 normal = polarDirection(vec3(0, 1, 0), vec3(1, 0, 0), (float(ring) + 0.5) * (0.5 * kTurn / kTupleRings),
                                       (float(azimuth) + 0.5) * (kTurn / kTupleAzimuths));
    const float angle = float(turn) * (kTurn / kTupleTurns);
    const mat2 turned = mat2(cos(angle), -sin(angle), sin(angle), cos(angle));
    const mat3 frame = mat3(turned) * (side == 0 ? tangentFrame(normal) : lowerTangentFrame(normal));
    const uint images = push.isGray != 0 ? (push.terms + 3) / 4 : (3 * push.terms + 3) / 4;
    vec4 a = vec4(0), b = vec4(0), c = vec4(0); // rgbr, gbrg, brgb, as tuples are stored
    for (int light = 0; light < int(kTupleLights); light++) {
        const vec3 local = frame * texelOf(lights, 2 * light).xyz;
        if (local.z <= kGrazingCosine) continue;
        const vec3 energy = local.z * texelOf(lights, 2 * light + 1).rgb;
        const vec2 place = diskMapCoordinates(push.mapping, local);
        if (push.isGray != 0) {
            const vec4 m = textureLod(lightMaps, vec3(place, quad), 0);
            a += m.xxxy * energy.rgbr;
            b += m.yyzz * energy.gbrg;
            c += m.zwww * energy.brgb;
        } else {
            a += textureLod(lightMaps, vec3(place, 3 * quad), 0) * energy.rgbr;
            if (3 * quad + 1 < images) b += textureLod(lightMaps, vec3(place, 3 * quad + 1), 0) * energy.gbrg;
            if (3 * quad + 2 < images) c += textureLod(lightMaps, vec3(place, 3 * quad + 2), 0) * energy.brgb;
        }
    }
    const uint image = push.rows * kTupleAzimuths;
    const uint first = (push.firstImage + 3 * quad) * image + row * kTupleAzimuths + azimuth;
    tuples[first] = a;
    tuples[first + image] = b;
    tuples[first + 2 * image] = c;
}
