#version 460
// Resamples the light about every view direction for which spheres are made: a polar map of radiance times solid
// angle.
// C++ twin: polarLight() in precompute/twins/lit_sphere_twin.h.
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 32) in;
layout(binding = 0) uniform sampler2DArray cube; // kSphereCube² texels and a border
TEXELS(1, vec4, samplerBuffer, Nodes, nodes); // axis and side, two texels per node
layout(binding = 2, std430) writeonly buffer Polar { vec4 polar[]; };

// Samples along a side of a cell: closer than texels, so that lookups sum to about the same wherever a light is.
const uint kSide = 2;

void main() {
    const uint azimuth = gl_GlobalInvocationID.x, ring = gl_GlobalInvocationID.y, node = gl_GlobalInvocationID.z;
    if (azimuth >= kSphereAzimuths) return;
    const vec3 axis = texelOf(nodes, int(2 * node)).xyz, side = texelOf(nodes, int(2 * node + 1)).xyz;
    const float ringWidth = 0.5 * kTurn / kSphereRings, width = kTurn / kSphereAzimuths;
    vec3 sides[kSide];
    for (uint i = 0; i < kSide; i++) {
        const float turn = (float(azimuth) - 0.5 + (float(i) + 0.5) / kSide) * width;
        sides[i] = cos(turn) * side + sin(turn) * cross(axis, side);
    }
    vec3 sum = vec3(0);
    float weights = 0;
    for (uint j = 0; j < kSide; j++) {
        const float angle = (float(ring) + (float(j) + 0.5) / kSide) * ringWidth, weight = sin(angle), along = cos(angle);
        for (uint i = 0; i < kSide; i++) {
            const vec3 direction = weight * sides[i] + along * axis;
            const uint face = cubeFace(direction);
            const vec2 place = (cubeCoordinates(face, direction) * (0.5 * kSphereCube) + 0.5 * kSphereCubeBordered) /
                               kSphereCubeBordered;
            sum += weight * textureLod(cube, vec3(place, face), 0).rgb;
            weights += weight;
        }
    }
    const float solidAngle = width * (cos(float(ring) * ringWidth) - cos(float(ring + 1) * ringWidth));
    polar[(node * kSphereRings + ring) * kSphereAzimuths + azimuth] = vec4(sum * (solidAngle / weights), 0);
}
