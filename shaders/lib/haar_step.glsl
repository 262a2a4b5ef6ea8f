// Haar steps on the values of a block; see lib/haar_block.glsl for the result's layout.
#ifndef RELUME_LIB_HAAR_STEP_GLSL
#define RELUME_LIB_HAAR_STEP_GLSL
#include "shaders/lib/haar_block.glsl"

float squaredMagnitude(vec3 value) {
    precise float sum = value.r * value.r + value.g * value.g + value.b * value.b;
    return sum;
}

void addToSummary(vec3 coefficient, inout vec2 summary) {
    const float squared = squaredMagnitude(coefficient);
    summary = vec2(max(summary.x, squared), summary.y + squared);
}

// Does one Haar step on [a b; c d]: stores its details from slot `first` on, and returns the average.
vec3 haarStep(vec3 a, vec3 b, vec3 c, vec3 d, uint first, inout vec3 slots[16], inout vec2 summary) {
    slots[first] = 0.5 * (a - b + c - d);
    slots[first + 1] = 0.5 * (a + b - c - d);
    slots[first + 2] = 0.5 * (a - b - c + d);
    for (uint i = 0; i < 3; i++) addToSummary(slots[first + i], summary);
    return 0.5 * (a + b + c + d);
}

// Transforms 4×4 values to 16 slots. The summary does not include the average.
void haarBlock(vec3 values[16], out vec3 slots[16], out vec2 summary) {
    vec3 quads[4];
    summary = vec2(0);
    for (uint i = 0; i < 4; i++) {
        const uint corner = (i / 2) * 8 + (i % 2) * 2;
        quads[i] = haarStep(values[corner], values[corner + 1], values[corner + 4], values[corner + 5], 3 * i, slots,
                            summary);
    }
    slots[15] = haarStep(quads[0], quads[1], quads[2], quads[3], 12, slots, summary);
}

// Returns four floats of a block, one of 12 such quarters: stores of four floats are the fastest.
vec4 slotQuarter(vec3 slots[16], uint quarter) {
    const uint first = quarter / 3 * 4;
    const vec3 a = slots[first], b = slots[first + 1], c = slots[first + 2], d = slots[first + 3];
    return quarter % 3 == 0 ? vec4(a, b.r) : quarter % 3 == 1 ? vec4(b.gb, c.rg) : vec4(c.b, d);
}

#endif
