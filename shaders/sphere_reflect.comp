#version 460
// Multiplies the light's spectrum with the kernel, frequency by frequency: a convolution in the azimuth about the
// view direction is a product of Fourier coefficients, here with a matrix over rings. An invocation does four rows of
// a component for two nodes.
// C++ twin: litSpheres() in precompute/twins/lit_sphere_twin.h, which does these passes as one sum.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/texels.glsl"
#include "shaders/shared/sphere.h"

layout(local_size_x = 8) in;
layout(push_constant, scalar) uniform Push { SpherePush push; };
TEXELS(0, vec4, samplerBuffer, Kernel, kernel);       // SphereKernel: [component][four rows][ring][channel]
TEXELS(1, vec4, samplerBuffer, Spectrum, spectrum); // [node][m][ring][real, imaginary]
layout(binding = 2, std430) writeonly buffer Reflected { vec4 reflected[]; }; // [node][component][four rows][6]

void main() {
    const uint rows = gl_GlobalInvocationID.x, component = gl_GlobalInvocationID.y, node = 2 * gl_GlobalInvocationID.z;
    if (rows >= kSphereRings / 4) return;
    const uint positive = push.frequencies + 1, all = 2 * push.frequencies + 1;
    // Components of harmonics above 0 begin with the most negative frequency.
    const int m = component < positive ? int(component) : int((component - positive) % all) - int(push.frequencies);
    const float side = m < 0 ? -1 : 1; // coefficients of real light at -m are the conjugates of those at m
    const bool hasSecond = node + 1 < push.nodes;
    const int lightStep = 2 * int((push.frequencies + 1) * kSphereRings);
    int light = int(node) * lightStep + 2 * int(uint(abs(m)) * kSphereRings);
    int weight = int((component * (kSphereRings / 4) + rows) * kSphereRings * 3);
    vec4 a[6] = vec4[](vec4(0), vec4(0), vec4(0), vec4(0), vec4(0), vec4(0)); // real r, g, b, imaginary r, g, b
    vec4 b[6] = vec4[](vec4(0), vec4(0), vec4(0), vec4(0), vec4(0), vec4(0));
    for (uint ring = 0; ring < kSphereRings; ring++, weight += 3, light += 2) {
        const vec4 red = texelOf(kernel, weight), green = texelOf(kernel, weight + 1),
                   blue = texelOf(kernel, weight + 2);
        vec3 re = texelOf(spectrum, light).rgb, im = texelOf(spectrum, light + 1).rgb;
        a[0] += re.r * red;
        a[1] += re.g * green;
        a[2] += re.b * blue;
        a[3] += im.r * red;
        a[4] += im.g * green;
        a[5] += im.b * blue;
        if (hasSecond) {
            re = texelOf(spectrum, light + lightStep).rgb;
            im = texelOf(spectrum, light + lightStep + 1).rgb;
            b[0] += re.r * red;
            b[1] += re.g * green;
            b[2] += re.b * blue;
            b[3] += im.r * red;
            b[4] += im.g * green;
            b[5] += im.b * blue;
        }
    }
    const uint components = positive + push.harmonics * all;
    for (uint i = 0; i < 6; i++) {
        const float conjugate = i < 3 ? 1 : side;
        reflected[((node * components + component) * (kSphereRings / 4) + rows) * 6 + i] = conjugate * a[i];
        if (hasSecond)
            reflected[(((node + 1) * components + component) * (kSphereRings / 4) + rows) * 6 + i] = conjugate * b[i];
    }
}
