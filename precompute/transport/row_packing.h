// Packs coefficients into rows on the CPU, where they do not come from the device's passes.
#pragma once

#include "engine/math/vector.h"

#include <cstdint>
#include <vector>

namespace relume {

// One row: its coefficients, quantized against the largest |component|, without those that became zero.
struct PackedRow {
    float scale = 0;
    std::vector<uint16_t> indices; // rising
    std::vector<uint32_t> values;  // as packCoefficient() makes them
};

// Returns the rising indices of the `count` of at most 65,536 coefficients that have the largest r² + g² + b²
// (of equal ones the first), without those that are zero.
std::vector<uint16_t> indicesOfLargest(const std::vector<vec3>& coefficients, int count);

// Packs the coefficients of indicesOfLargest(): the same row as shaders/select.comp and quantize.comp make.
PackedRow packLargest(const std::vector<vec3>& coefficients, int count);

} // namespace relume
