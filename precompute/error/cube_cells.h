// The directions of a cube's texels in Morton order, in which aligned squares are contiguous.
#pragma once

#include "engine/light/light_cube.h"

#include <cstdint>
#include <span>
#include <vector>

namespace relume {

// Cells are ordered face by face, each along mortonPlace(): the 4^n cells inside a cell of a cube 2^n times
// coarser are consecutive.
struct CubeCells {
    int size; // cells per side of a face, a power of two
    std::vector<vec3> directions;
    std::vector<float> solidAngles;
    std::vector<uint32_t> texels; // per cell: its index in row order, as in LightCube

    explicit CubeCells(int faceSize);
    size_t count() const { return directions.size(); }

    // Returns the radiance of a cube of this size in the order of cells.
    std::vector<vec3> ordered(const LightCube& cube) const;
};

// Returns the share of ones among the bits [first, first + count). `count` is 1 or a power of four up to 64;
// `first` is a multiple of it.
float shareOfOnes(std::span<const uint64_t> bits, size_t first, size_t count);

} // namespace relume
