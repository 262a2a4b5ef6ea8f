// Packs coefficients into rows on the CPU.
#pragma once

#include "engine/math/vector.h"

#include <cstdint>
#include <vector>

namespace relume {

// A row: coefficients quantized relative to the largest |component|, without those that became zero.
struct PackedRow {
    float scale = 0;
    std::vector<uint16_t> indices; // ascending
    std::vector<uint32_t> values;  // from packCoefficient()
};

// Returns, ascending, the indices of the `count` nonzero coefficients of largest r² + g² + b²; ties go to the
// lower index. Takes at most 65,536 coefficients.
std::vector<uint16_t> indicesOfLargest(const std::vector<vec3>& coefficients, int count);

// Packs the coefficients of indicesOfLargest() into the row that shaders/select.comp and quantize.comp make.
PackedRow packLargest(const std::vector<vec3>& coefficients, int count);

} // namespace relume
