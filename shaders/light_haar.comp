#version 460
// Applies the orthonormal 2D Haar transform to the lighting cube: a work-group per face and channel.
// C++ twin: haarForward() in engine/math/haar.h.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/light.h"

layout(local_size_x = 128) in;
layout(constant_id = 0) const uint kSize = 64;
layout(binding = 0, std430) readonly buffer Radiance { float radiance[]; };
layout(binding = 1, std430) writeonly buffer Coefficients { float coefficients[]; };

// The averages of the previous and of this level, alternating.
const uint kHalf = kSize / 2;
shared float averages[2][kHalf * kHalf];

uint place(uint x, uint y) {
    const uint face = gl_WorkGroupID.y, channel = gl_WorkGroupID.z;
    return 3 * ((face * kSize + y) * kSize + x) + channel;
}

// Returns a texel's radiance, or 0 if it is below kLeastRadiance.
float loadRadiance(uint x, uint y) {
    const float value = radiance[place(x, y)];
    return abs(value) < kLeastRadiance ? 0 : value;
}

void main() {
    uint level = 0;
    for (uint side = kHalf; side >= 1; side /= 2) {
        for (uint block = gl_LocalInvocationID.x; block < side * side; block += gl_WorkGroupSize.x) {
            const uint x = block % side, y = block / side;
            float a, b, c, d;
            if (side == kHalf) {
                a = loadRadiance(2 * x, 2 * y);
                b = loadRadiance(2 * x + 1, 2 * y);
                c = loadRadiance(2 * x, 2 * y + 1);
                d = loadRadiance(2 * x + 1, 2 * y + 1);
            } else {
                const uint from = 4 * y * side + 2 * x;
                a = averages[1 - level][from];
                b = averages[1 - level][from + 1];
                c = averages[1 - level][from + 2 * side];
                d = averages[1 - level][from + 2 * side + 1];
            }
            // In the twin's order of operations, for the same bits.
            precise const float average = 0.5 * (a + b + c + d), right = 0.5 * (a - b + c - d);
            precise const float down = 0.5 * (a + b - c - d), both = 0.5 * (a - b - c + d);
            averages[level][block] = average;
            coefficients[place(x + side, y)] = right;
            coefficients[place(x, y + side)] = down;
            coefficients[place(x + side, y + side)] = both;
            if (side == 1) coefficients[place(0, 0)] = average;
        }
        level = 1 - level;
        barrier();
    }
}
