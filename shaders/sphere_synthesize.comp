#version 460
// Synthesizes spheres from Fourier coefficients: an invocation does four rows and four azimuths, for one harmonic of
// the view's azimuth. Harmonic 0 is real.
// C++ twin: litSpheres() in precompute/twins/lit_sphere_twin.h, which does these passes as one sum.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/polar_map.glsl"
#include "shaders/lib/texels.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 8) in;
layout(push_constant, scalar) uniform Push { SpherePush push; };
TEXELS(0, vec4, samplerBuffer, Reflected, reflected); // [node][component][four rows][6]
layout(binding = 1, std430) writeonly buffer Parts { vec4 parts[]; }; // [node][part][ring][azimuth]

void main() {
    const uint first = 4 * gl_GlobalInvocationID.x, rows = gl_GlobalInvocationID.y;
    const uint harmonic = gl_GlobalInvocationID.z % (push.harmonics + 1);
    const uint node = gl_GlobalInvocationID.z / (push.harmonics + 1);
    if (first >= kSphereAzimuths) return;
    const int most = int(push.frequencies), least = harmonic == 0 ? 0 : -most;
    const uint positive = push.frequencies + 1, all = 2 * push.frequencies + 1;
    const uint components = positive + push.harmonics * all;
    uint component = harmonic == 0 ? 0 : positive + (harmonic - 1) * all;
    const vec4 azimuths = (float(first) + vec4(0, 1, 2, 3)) * (kTurn / kSphereAzimuths);
    const vec4 stepRe = cos(azimuths), stepIm = sin(azimuths);
    vec4 phaseRe = cos(float(least) * azimuths), phaseIm = sin(float(least) * azimuths);
    vec4 re[12], im[12]; // channel · 4 + azimuth, of four rows
    for (uint i = 0; i < 12; i++) re[i] = im[i] = vec4(0);
    for (int m = least; m <= most; m++, component++) {
        const int place = int(((node * components + component) * (kSphereRings / 4) + rows) * 6);
        for (int channel = 0; channel < 3; channel++) {
            const vec4 x = texelOf(reflected, place + channel), y = texelOf(reflected, place + 3 + channel);
            for (int i = 0; i < 4; i++) {
                re[4 * channel + i] += x * phaseRe[i] - y * phaseIm[i];
                if (harmonic > 0) im[4 * channel + i] += x * phaseIm[i] + y * phaseRe[i];
            }
        }
        const vec4 turned = phaseRe * stepRe - phaseIm * stepIm;
        phaseIm = phaseRe * stepIm + phaseIm * stepRe;
        phaseRe = turned;
    }
    const uint part = harmonic == 0 ? 0 : 2 * harmonic - 1, allParts = 2 * push.harmonics + 1;
    for (uint row = 0; row < 4; row++)
        for (uint i = 0; i < 4; i++) {
            const uint place =
                ((node * allParts + part) * kSphereRings + 4 * rows + row) * kSphereAzimuths + first + i;
            parts[place] = vec4(re[i][row], re[4 + i][row], re[8 + i][row], 0);
            if (harmonic > 0)
                parts[place + kSphereRings * kSphereAzimuths] = vec4(im[i][row], im[4 + i][row], im[8 + i][row], 0);
        }
}
