// Packing of coefficients in 11, 11 and 10 bits. C++ twin: engine/transport/rows/sparse_transport.h.
#ifndef RELUME_LIB_PACKING_GLSL
#define RELUME_LIB_PACKING_GLSL

const ivec3 kCoefficientMaximum = ivec3(1023, 1023, 511);
const vec3 kCoefficientUnit = vec3(1.0 / 1023, 1.0 / 1023, 1.0 / 511);

uint packCoefficient(ivec3 q) {
    return (uint(q.r) & 0x7ffu) | (uint(q.g) & 0x7ffu) << 11 | (uint(q.b) & 0x3ffu) << 22;
}

ivec3 unpackCoefficient(uint word) {
    const int bits = int(word);
    return ivec3(bitfieldExtract(bits, 0, 11), bitfieldExtract(bits, 11, 11), bitfieldExtract(bits, 22, 10));
}

// Quantizes a coefficient, to nearest, halves away from zero; `scale` maps to the maxima.
ivec3 quantizeCoefficient(vec3 value, float scale) {
    precise vec3 steps = value / scale * vec3(kCoefficientMaximum);
    return ivec3(sign(steps) * floor(abs(steps) + 0.5));
}

#endif
