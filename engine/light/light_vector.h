// The light in the Haar basis, quantised and sparse.
#pragma once

#include "engine/light/light_cube.h"

#include <array>
#include <cstdint>

namespace relume {

// Largest |quantised coefficient|, and the default of the threshold (of kLightMaximum, where that stands for
// the largest component) below which all three channels must lie for a coefficient to be dropped.
constexpr int kLightMaximum = 32767;
constexpr int kDefaultLightThreshold = 1024;

// Most entries (a cube of 64² texels a face), and the most that Σ|value| of a channel may be: a product
// with coefficients of at most 2^10 in magnitude (11 bits) then sums to less than 2^31 in any order.
constexpr uint32_t kMaximumLightEntries = 6 * 64 * 64;
constexpr uint32_t kLightSumLimit = (1u << 21) - 1;

struct LightVector {
    int faceSize = 0;                           // F
    float scale = 0;                            // coefficient = scale · quantised value; a power of two
    std::vector<uint16_t> indices;              // face·F² + y·F + x, rising
    std::vector<std::array<int16_t, 3>> values; // quantised, in [-32767, 32767]
};

// The share of the light's largest component that a kept entry's largest is at least: (threshold - ½) /
// kLightMaximum, or 0.
float keptShare(int threshold);

// CPU twin of the light passes:
//   1. c = the Haar transform of each face; m = the largest |component| of all. Components below 2^-126 count
//      as 0: devices may flush them. Without any other, nothing is kept.
//   2. Kept are the entries with some |component| of at least m · keptShare(threshold).
//   3. step = the smallest power of two, from 2^-126, with m / step ≤ kLightMaximum and, for every channel,
//      Σ|q| ≤ kLightSumLimit over the kept, where q = sign(c) floor(|c| / step + ½).
//   4. values of the kept: q, without those that are all zero; scale = step.
// Steps that are powers of two divide without rounding, so that every device gives the same q; and what is on
// the grid of one light's step is on that of every finer one, so that lights can be subtracted exactly.
// The cube must be finite, of a power of two of at most 64 texels a side.
LightVector makeLightVector(const LightCube& cube, int threshold = kDefaultLightThreshold);

// The light that the vector stands for: inverse transform of scale · values. For showing and measuring.
LightCube reconstruct(const LightVector& vector);

} // namespace relume
