// The light in the Haar basis, quantised and sparse.
#pragma once

#include "engine/light/light_cube.h"

#include <array>

namespace relume {

// Largest |quantised coefficient|, and the default of the threshold below which all three channels
// must lie for a coefficient to be dropped.
constexpr int kLightMaximum = 32767;
constexpr int kDefaultLightThreshold = 1024;

struct LightVector {
    int faceSize = 0;                           // F
    float scale = 0;                            // coefficient = scale · quantised value
    std::vector<uint16_t> indices;              // face·F² + y·F + x, rising
    std::vector<std::array<int16_t, 3>> values; // quantised, in [-32767, 32767]
};

// Transforms, quantises against the largest coefficient of all channels and drops what lies below
// `threshold` (0 keeps all but zeros). If Σ|value| of a channel could carry a sum of products with
// 11-bit coefficients past 2^31, the scale is coarsened until it cannot. CPU twin of the light passes.
LightVector makeLightVector(const LightCube& cube, int threshold = kDefaultLightThreshold);

// The light that the vector stands for: inverse transform of scale · values. For showing and measuring.
LightCube reconstruct(const LightVector& vector);

} // namespace relume
