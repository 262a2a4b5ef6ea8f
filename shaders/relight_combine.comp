#version 460
// Computes the tuples of a cluster's vertices in one term: the projections on its basis vectors times the vertices'
// weights, summed in the order of the components, kind after kind. An invocation does eight vertices, so that a
// projection serves several. Clusters whose projections have not changed are skipped, as are those that have none,
// whose tuples stay zero.
// C++ twin: relight() in precompute/twins/relight_twin.h. Layout: engine/transport/bases/bases_relighter.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/texels.glsl"
#include "shaders/shared/render.h"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { RelightCombinePush push; };
layout(binding = 0, scalar) readonly buffer Clusters { BasisVertices clusters[]; };
layout(binding = 1, scalar) readonly buffer Terms { BasisTermKinds termKinds[]; };
layout(binding = 2, scalar) readonly buffer Colors { vec3 colors[]; };          // of kinds
layout(binding = 3, scalar) readonly buffer Weightings { BasisWeighting weightings[]; }; // by cluster and kind
TEXELS(4, uvec2, usamplerBuffer, Weights, weights); // two words: eight vertices
TEXELS(5, float, samplerBuffer, Scales, scales);
TEXELS(6, vec4, samplerBuffer, Projections, projections);
layout(binding = 7, scalar) writeonly buffer Tuples { vec3 tuples[]; };
layout(binding = 8, std430) readonly buffer Stamps { uint stamps[]; }; // of relight_project

const uint kVertices = 8;

vec4 unpackWeights(uint word) {
    const int four = int(word);
    return vec4(bitfieldExtract(four, 0, 8), bitfieldExtract(four, 8, 8), bitfieldExtract(four, 16, 8), four >> 24);
}

#define STORE(i, half, c)                                                                                              \
    if (vertex + i < end) tuples[(vertex + i) * push.terms + term] = vec3(red[half].c, green[half].c, blue[half].c);

void main() {
    const uint perCluster = push.terms * push.groupsPerTerm;
    const uint number = gl_WorkGroupID.x / perCluster, term = gl_WorkGroupID.x % perCluster / push.groupsPerTerm;
    if (stamps[number] != push.stamp) return;
    const BasisVertices cluster = clusters[number];
    const uint octet = gl_WorkGroupID.x % push.groupsPerTerm * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (octet * kVertices >= cluster.vertices) return;
    // One channel of eight vertices takes two registers.
    precise vec4 red[2] = vec4[](vec4(0), vec4(0)), green[2] = red, blue[2] = red;
    const BasisTermKinds kinds = termKinds[term];
    for (uint kind = kinds.first; kind < kinds.first + kinds.count; kind++) {
        const BasisWeighting weighting = weightings[number * push.kinds + kind];
        precise vec4 kindRed[2] = vec4[](vec4(0), vec4(0)), kindGreen[2] = kindRed, kindBlue[2] = kindRed;
        const int place = int(weighting.firstWeights + octet * weighting.components);
        for (int i = 0; i < int(weighting.components); i++) {
            precise const vec3 projection = texelOf(projections, int(cluster.firstComponent) + i).rgb *
                                            texelOf(scales, int(weighting.firstScale) + i).x;
            const uvec2 words = texelOf(weights, place + i).xy;
            const vec4 low = unpackWeights(words.x), high = unpackWeights(words.y);
            kindRed[0] += low * projection.r;
            kindRed[1] += high * projection.r;
            kindGreen[0] += low * projection.g;
            kindGreen[1] += high * projection.g;
            kindBlue[0] += low * projection.b;
            kindBlue[1] += high * projection.b;
        }
        const vec3 color = colors[kind];
        red[0] += kindRed[0] * color.r;
        red[1] += kindRed[1] * color.r;
        green[0] += kindGreen[0] * color.g;
        green[1] += kindGreen[1] * color.g;
        blue[0] += kindBlue[0] * color.b;
        blue[1] += kindBlue[1] * color.b;
    }
    const uint vertex = cluster.firstVertex + octet * kVertices, end = cluster.firstVertex + cluster.vertices;
    STORE(0, 0, x)
    STORE(1, 0, y)
    STORE(2, 0, z)
    STORE(3, 0, w)
    STORE(4, 1, x)
    STORE(5, 1, y)
    STORE(6, 1, z)
    STORE(7, 1, w)
}
