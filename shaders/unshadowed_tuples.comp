#version 460
// Sums the unshadowed tuples of all normals, of the whole light and of its fill: polar maps about +Y, four terms per
// invocation.
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
TEXELS(0, vec4, samplerBuffer, Lights, lights);           // kCellTexels each
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
    // Four terms of the whole light and of its fill: rgbr, gbrg, brgb, as tuples are stored.
    mat3x4 whole = mat3x4(0), fill = mat3x4(0);
    for (int light = 0; light < int(kTupleLights); light++) {
        const int texel = int(kCellTexels) * light;
        const vec3 local = frame * texelOf(lights, texel).xyz;
        if (local.z <= kGrazingCosine) continue;
        const vec3 energy = local.z * texelOf(lights, texel + 1).rgb, ofFill = local.z * texelOf(lights, texel + 2).rgb;
        const vec2 place = diskMapCoordinates(push.mapping, local);
        mat3x4 maps = mat3x4(0);
        if (push.isGray != 0) {
            const vec4 m = textureLod(lightMaps, vec3(place, quad), 0);
            maps = mat3x4(m.xxxy, m.yyzz, m.zwww);
        } else {
            for (uint i = 0; i < 3; i++)
                if (3 * quad + i < images) maps[i] = textureLod(lightMaps, vec3(place, 3 * quad + i), 0);
        }
        whole += matrixCompMult(maps, mat3x4(energy.rgbr, energy.gbrg, energy.brgb));
        fill += matrixCompMult(maps, mat3x4(ofFill.rgbr, ofFill.gbrg, ofFill.brgb));
    }
    const uint image = push.rows * kTupleAzimuths;
    const uint first = (push.firstImage + 3 * quad) * image + row * kTupleAzimuths + azimuth;
    for (uint i = 0; i < 3; i++) {
        tuples[first + i * image] = whole[i];
        tuples[first + (push.fillImages + i) * image] = fill[i];
    }
}
