// Haar steps on blocks of values: lib/haar_block.glsl says where their results belong.
#ifndef RELUME_LIB_HAAR_STEP_GLSL
#define RELUME_LIB_HAAR_STEP_GLSL
#include "shaders/lib/haar_block.glsl"
#include "shaders/shared/bake.h"

// Kernels that include this say where coefficients go.
void storeCoefficient(uint row, uint face, uvec2 place, vec3 value, float squared);

float squaredMagnitude(vec3 value) {
    precise float sum = value.r * value.r + value.g * value.g + value.b * value.b;
    return sum;
}

void addCoefficient(uint row, uint face, uvec2 place, vec3 value, inout BlockSummary summary) {
    const float squared = squaredMagnitude(value);
    storeCoefficient(row, face, place, value, squared);
    summary.largest = max(summary.largest, squared);
    summary.energy += squared;
}

// One Haar step on [a b; c d]: stores the details, the first of which is `slot`, and returns the average.
vec3 haarStep(vec3 a, vec3 b, vec3 c, vec3 d, uint row, uint face, uvec2 block, uint slot, uint width,
              inout BlockSummary summary) {
    addCoefficient(row, face, haarSlotPlace(block, slot, width), 0.5 * (a - b + c - d), summary);
    addCoefficient(row, face, haarSlotPlace(block, slot + 1, width), 0.5 * (a + b - c - d), summary);
    addCoefficient(row, face, haarSlotPlace(block, slot + 2, width), 0.5 * (a - b - c + d), summary);
    return 0.5 * (a + b + c + d);
}

vec3 haarBlock(vec3 values[16], uint row, uint face, uvec2 block, uint width, inout BlockSummary summary) {
    vec3 quads[4];
    for (uint i = 0; i < 4; i++) {
        const uint corner = (i / 2) * 8 + (i % 2) * 2;
        quads[i] = haarStep(values[corner], values[corner + 1], values[corner + 4], values[corner + 5], row, face,
                            block, 3 * i, width, summary);
    }
    return haarStep(quads[0], quads[1], quads[2], quads[3], row, face, block, 12, width, summary);
}

#endif
