#version 460
// Shows properties of the mesh instead of radiance: its triangles, its normals, or its density.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/barycentric.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/shared/render.h"

layout(push_constant, scalar) uniform Push { ViewInspectPush push; };
#ifdef MULTISAMPLED
#include "shaders/lib/pixel_samples.glsl"
#else
layout(binding = 0) uniform usampler2DArray triangleIds; // as in view_shade.frag
#endif
TEXELS(1, uvec4, usamplerBuffer, Triangles, triangles);
TEXELS(2, vec4, samplerBuffer, Vertices, vertices);

layout(location = 0) out vec4 radiance;

const vec3 kLine = vec3(0.9, 0.45, 0.05);

// Returns 1 on a triangle's edges and 0 from a pixel off them. Less where triangles are a few pixels high, so that
// lines do not hide them.
float edge(vec3 direction, vec3 corners[3], vec3 weights) {
    const vec3 perX = barycentricWeights(push.rays.eye, direction + push.rays.right, corners) - weights;
    const vec3 perY = barycentricWeights(push.rays.eye, direction + push.rays.down, corners) - weights;
    const vec3 heights = 1 / max(sqrt(perX * perX + perY * perY), vec3(1e-20)); // in pixels
    const vec3 pixels = weights * heights;
    const float fade = clamp(min(min(heights.x, heights.y), heights.z) / 6, 0.2, 1);
    return fade * (1 - clamp(min(min(pixels.x, pixels.y), pixels.z), 0, 1));
}

// Returns blue at sixteen times the median area and more, white at the median, red at a sixteenth and less.
vec3 densityColor(float area) {
    const float density = clamp(log2(push.medianArea / max(area, 1e-30)) / 4, -1, 1);
    return mix(vec3(0.85), density < 0 ? vec3(0.02, 0.1, 0.8) : vec3(0.8, 0.03, 0.02), abs(density));
}

// Returns the color of a triangle where the ray through a point of the image meets it.
vec3 colorAt(uint triangle, vec2 place) {
    const vec3 direction = push.rays.corner + place.x * push.rays.right + place.y * push.rays.down;
    const uvec3 numbers = texelOf(triangles, int(triangle)).xyz;
    vec3 corners[3], normals[3];
    for (int c = 0; c < 3; c++) {
        const vec4 low = texelOf(vertices, int(numbers[c] * kVertexTexels));
        corners[c] = low.xyz;
        normals[c] = vec3(low.w, texelOf(vertices, int(numbers[c] * kVertexTexels + 1)).xy);
    }
    const vec3 weights = barycentricWeights(push.rays.eye, direction, corners);
    const vec3 normal = normalize(weights.x * normals[0] + weights.y * normals[1] + weights.z * normals[2]);
    const float facing = abs(dot(normal, normalize(direction)));
    vec3 color = mix(vec3(0.04 + 0.2 * facing), kLine, edge(direction, corners, weights));
    // Stored so that displays show 0.5 + 0.5 n, as normal maps do.
    if (push.mode == kInspectNormals) color = pow(0.5 + 0.5 * normal, vec3(2.2));
    if (push.mode == kInspectDensity)
        color = (0.3 + 0.7 * facing) *
                densityColor(0.5 * length(cross(corners[1] - corners[0], corners[2] - corners[0])));
    return color;
}

bool isOfPart(uint triangleId) { return triangleId - push.firstTriangleId < push.triangleCount; }

void main() {
#ifdef MULTISAMPLED
    uint seen[kSamples];
    readSamples(seen);
    radiance = vec4(0);
    for (uint i = 0; i < kSamples; i++) {
        if (!isOfPart(seen[i])) continue;
        const vec2 place = floor(gl_FragCoord.xy) + samplePosition(i);
        radiance += vec4(colorAt(seen[i] - push.firstTriangleId, place), 1) / kSamples;
    }
    if (radiance.a == 0) discard;
#else
    const uint triangleId = texelFetch(triangleIds, ivec3(gl_FragCoord.xy, 0), 0).x;
    if (!isOfPart(triangleId)) discard;
    radiance = vec4(colorAt(triangleId - push.firstTriangleId, gl_FragCoord.xy), 1);
#endif
}
