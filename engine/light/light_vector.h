// The light in the Haar basis, as sparse, quantized entries.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/light/light_selection.h"

#include <array>
#include <cstdint>

namespace relume {

// The most entries (a cube of 64² texels a face), and the largest Σ|value| of a channel: a product with
// coefficients of at most 2^10 in magnitude (11 bits) then sums to less than 2^31 in any order.
constexpr uint32_t kMaximumLightEntries = 6 * 64 * 64;
constexpr uint32_t kLightSumLimit = (1u << 21) - 1;

// The light entries: quantized Haar coefficients.
struct LightVector {
    int faceSize = 0;                           // F
    float scale = 0;                            // coefficient = scale · quantized value; a power of two
    float error = 0;                            // relative L2 of what was dropped and rounded
    std::vector<uint16_t> indices;              // face·F² + y·F + x, rising
    std::vector<std::array<int16_t, 3>> values; // quantized, in [-32767, 32767]
};

// Transforms, selects and quantizes the light. CPU twin of LightTable:
//   1. Components of texels below kLeastRadiance count as 0: sums and differences of the others are normal
//      floats, which no device flushes to zero. c = the Haar transform of each face; m = the largest
//      |component| of all. If m is 0, nothing is kept.
//   2. `selection` chooses the entries that are kept.
//   3. step = the smallest power of two with m / step ≤ kLightMaximum and, for every channel,
//      Σ|q| ≤ kLightSumLimit over the kept, where q = sign(c) floor(|c| / step + ½).
//   4. Values are the q of kept entries, without those that are all zero; scale = step;
//      error = √(Σ (c - step q)² / Σ c²) over all entries and channels, q = 0 for those not kept.
// Steps that are powers of two divide without rounding, so that every device gives the same q. A value on the
// grid of one light's step is on that of every finer step, so that lights can be subtracted exactly.
// The cube must be finite, of a power of two of at most 64 texels a side.
LightVector makeLightVector(const LightCube& cube, const LightSelection& selection = {});

// Reconstructs the light, by the inverse transform of scale · values, for display and measurements.
LightCube reconstruct(const LightVector& vector);

} // namespace relume
