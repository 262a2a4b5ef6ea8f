// The directions of a cube's texels along the Morton curve, where aligned squares are runs.
#pragma once

#include "engine/light/light_cube.h"

#include <cstdint>
#include <span>
#include <vector>

namespace relume {

// Face after face, each along mortonPlace: the 4^n cells in a cell of a cube 2^n times as coarse are
// neighbors.
struct CubeCells {
    int size; // cells a side of a face, a power of two
    std::vector<vec3> directions;
    std::vector<float> solidAngles;
    std::vector<uint32_t> texels; // of each cell: its index row by row, as LightCube has it

    explicit CubeCells(int faceSize);
    size_t count() const { return directions.size(); }

    // A cube of this size in the order of cells.
    std::vector<vec3> ordered(const LightCube& cube) const;
};

// The share of ones among the bits [first, first + count); count is 1 or a power of four up to 64, first a
// multiple of it.
float shareOfOnes(std::span<const uint64_t> bits, size_t first, size_t count);

} // namespace relume
