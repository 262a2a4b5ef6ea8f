// The light in the Haar basis, quantised and sparse.
#pragma once

#include "engine/light/light_cube.h"

#include <array>
#include <cstdint>

namespace relume {

// Largest |quantised coefficient|, and the default of the threshold below which all three channels
// must lie for a coefficient to be dropped.
constexpr int kLightMaximum = 32767;
constexpr int kDefaultLightThreshold = 1024;

// Most entries (a cube of 64² texels a face), and the most that Σ|value| of a channel may be: a product
// with coefficients of at most 2^10 in magnitude (11 bits) then sums to less than 2^31 in any order.
constexpr uint32_t kMaximumLightEntries = 6 * 64 * 64;
constexpr uint32_t kLightSumLimit = (1u << 21) - 1;

struct LightVector {
    int faceSize = 0;                           // F
    float scale = 0;                            // coefficient = scale · quantised value
    std::vector<uint16_t> indices;              // face·F² + y·F + x, rising
    std::vector<std::array<int16_t, 3>> values; // quantised, in [-32767, 32767]
};

// What the largest coefficient becomes when quantising to kLightMaximum gave `magnitudeSum` = the largest
// channel's Σ|value| over the kept entries: kLightMaximum if that is within kLightSumLimit, else less, so
// that requantising keeps the limit whichever way the entries round. With S = magnitudeSum and
// n = kMaximumLightEntries: floor((kLightSumLimit - n) / ceil((S + n) / kLightMaximum)); all fits 32 bits.
int lightMaximumFor(uint32_t magnitudeSum);

// CPU twin of the light passes:
//   1. c = the Haar transform of each face; m = the largest |component| of all (0: nothing is kept).
//   2. q = sign(c) floor(|c| / m · 32767 + ½); kept are the entries with some |component of q| of at least
//      `threshold` (and at least 1, so 0 keeps all but zeros).
//   3. M = lightMaximumFor(the largest channel's Σ|q| over the kept).
//   4. values of the kept: q again, with M for 32767, and again without those that are all zero;
//      scale = m / M.
// The cube must be finite, of a power of two of at most 64 texels a side.
LightVector makeLightVector(const LightCube& cube, int threshold = kDefaultLightThreshold);

// The light that the vector stands for: inverse transform of scale · values. For showing and measuring.
LightCube reconstruct(const LightVector& vector);

} // namespace relume
