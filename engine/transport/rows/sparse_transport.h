// Transport in rows: sparse, quantized Haar coefficients, one row per vertex and term.
#pragma once

#include "engine/math/vector.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace relume {

// A set's transport in rows. Row r = vertex · terms + term. Entry e of a row is coefficient `indices[e]` with
// value unpackCoefficient(values[e]) · scale · kCoefficientUnit.
struct SparseTransport {
    static constexpr const char* kName = "rows";
    static constexpr std::array<char, 4> kTag = {'T', 'R', 'A', 'N'};

    uint32_t vertices = 0;
    uint32_t terms = 0;
    std::vector<uint64_t> rowStarts; // rows + 1: first entry of each row
    std::vector<float> scales;       // per row: the largest |component| before quantization
    std::vector<uint16_t> indices;   // per entry: face·F² + y·F + x, rising within a row
    std::vector<uint32_t> values;    // per entry: packed 11/11/10

    size_t rows() const { return size_t(vertices) * terms; }
    size_t entries() const { return values.size(); }
    uint64_t bytes() const;
    // Dequantizes a row to `coefficients`, which must be zero before.
    void dequantizeRow(size_t row, std::span<vec3> coefficients) const;
};

// The packing of a coefficient in 11, 11 and 10 signed bits, red lowest. GLSL twin: shaders/lib/packing.glsl.
constexpr int kRedMaximum = 1023, kGreenMaximum = 1023, kBlueMaximum = 511;
constexpr vec3 kCoefficientUnit{1.0f / 1023, 1.0f / 1023, 1.0f / 511};
inline uint32_t packCoefficient(ivec3 q) {
    return (uint32_t(q.x) & 0x7ffu) | (uint32_t(q.y) & 0x7ffu) << 11 | (uint32_t(q.z) & 0x3ffu) << 22;
}
inline ivec3 unpackCoefficient(uint32_t packed) {
    // A field shifted to the top comes back down with its sign.
    return {int32_t(packed << 21) >> 21, int32_t(packed << 10) >> 21, int32_t(packed) >> 22};
}

// Checks that rows have at most `longestRow` entries, with rising indices below `coefficients`, and that
// values are in range. Throws Error; `where` names the transport in it.
void checkTransport(const SparseTransport& transport, uint32_t coefficients, uint64_t longestRow,
                    const std::string& where);

// Quantizes to nearest, halves away from zero; `scale` maps to the maxima. A scale of 0 gives 0.
ivec3 quantizeCoefficient(vec3 value, float scale);

} // namespace relume
