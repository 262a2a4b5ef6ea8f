#version 460
// Anisotropic spheres from their harmonics: each place of a sphere has a normal, and the view an azimuth in its tangent
// frame.
// C++ twin: litSphere() in precompute/reference/lit_sphere_twin.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/tangent_frame.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { SpherePush push; };
layout(binding = 0) uniform samplerBuffer parts; // [node][part][ring][azimuth]
layout(binding = 1) uniform samplerBuffer nodes; // axis and side, two texels a node
layout(binding = 2, std430) writeonly buffer Spheres { vec4 spheres[]; }; // [node][ring][azimuth]

void main() {
    const uint azimuth = gl_GlobalInvocationID.x, ring = gl_GlobalInvocationID.y, node = gl_GlobalInvocationID.z;
    if (azimuth >= kSphereAzimuths) return;
    const vec3 axis = texelFetch(nodes, int(2 * node)).xyz, side = texelFetch(nodes, int(2 * node + 1)).xyz;
    const vec3 normal = polarDirection(axis, side, (float(ring) + 0.5) * (0.25 * kTurn / kSphereRings),
                                       float(azimuth) * (kTurn / kSphereAzimuths));
    const vec3 local = tangentFrame(normal) * axis;
    const float turn = local.x == 0 && local.y == 0 ? 0 : atan(local.y, local.x);

    const int plane = int(kSphereRings * kSphereAzimuths), place = int(ring * kSphereAzimuths + azimuth);
    const int start = int(node) * (2 * int(push.harmonics) + 1) * plane + place;
    vec3 sum = texelFetch(parts, start).rgb;
    for (int harmonic = 1; harmonic <= int(push.harmonics); harmonic++)
        sum += cos(2 * harmonic * turn) * texelFetch(parts, start + (2 * harmonic - 1) * plane).rgb -
               sin(2 * harmonic * turn) * texelFetch(parts, start + 2 * harmonic * plane).rgb;
    spheres[int(node) * plane + place] = vec4(sum, 0);
}
