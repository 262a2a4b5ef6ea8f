#version 460
// Computes the azimuthal Fourier coefficients of polar light, Σ L e^(-imφ), from m = 0: eight frequencies of a ring
// per invocation.
// C++ twin: litSpheres() in precompute/twins/lit_sphere_twin.h, which does these passes as one sum.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 16) in;
layout(push_constant, scalar) uniform Push { SpherePush push; };
TEXELS(0, vec4, samplerBuffer, Polar, polar);
layout(binding = 1, std430) writeonly buffer Spectrum { vec4 spectrum[]; }; // [node][m][ring][real, imaginary]

void main() {
    const uint ring = gl_GlobalInvocationID.x, first = 8 * gl_GlobalInvocationID.y, node = gl_GlobalInvocationID.z;
    if (ring >= kSphereRings) return;
    const vec4 low = float(first) + vec4(0, 1, 2, 3), high = low + 4;
    const vec4 lowStepRe = cos(low * (kTurn / kSphereAzimuths)), lowStepIm = -sin(low * (kTurn / kSphereAzimuths));
    const vec4 highStepRe = cos(high * (kTurn / kSphereAzimuths)), highStepIm = -sin(high * (kTurn / kSphereAzimuths));
    vec4 lowRe = vec4(1), lowIm = vec4(0), highRe = vec4(1), highIm = vec4(0);
    vec4 re[6] = vec4[](vec4(0), vec4(0), vec4(0), vec4(0), vec4(0), vec4(0)); // r, g, b of low, then of high
    vec4 im[6] = vec4[](vec4(0), vec4(0), vec4(0), vec4(0), vec4(0), vec4(0));
    const int start = int((node * kSphereRings + ring) * kSphereAzimuths);
    for (int azimuth = 0; azimuth < int(kSphereAzimuths); azimuth++) {
        const vec3 light = texelOf(polar, start + azimuth).rgb;
        re[0] += light.r * lowRe;
        re[1] += light.g * lowRe;
        re[2] += light.b * lowRe;
        im[0] += light.r * lowIm;
        im[1] += light.g * lowIm;
        im[2] += light.b * lowIm;
        re[3] += light.r * highRe;
        re[4] += light.g * highRe;
        re[5] += light.b * highRe;
        im[3] += light.r * highIm;
        im[4] += light.g * highIm;
        im[5] += light.b * highIm;
        vec4 turned = lowRe * lowStepRe - lowIm * lowStepIm;
        lowIm = lowRe * lowStepIm + lowIm * lowStepRe;
        lowRe = turned;
        turned = highRe * highStepRe - highIm * highStepIm;
        highIm = highRe * highStepIm + highIm * highStepRe;
        highRe = turned;
    }
    for (uint i = 0; i < 8; i++) {
        const uint m = first + i, half4 = i / 4 * 3;
        if (m > push.frequencies) break;
        const uint place = 2 * ((node * (push.frequencies + 1) + m) * kSphereRings + ring);
        spectrum[place] = vec4(re[half4][i % 4], re[half4 + 1][i % 4], re[half4 + 2][i % 4], 0);
        spectrum[place + 1] = vec4(im[half4][i % 4], im[half4 + 1][i % 4], im[half4 + 2][i % 4], 0);
    }
}
