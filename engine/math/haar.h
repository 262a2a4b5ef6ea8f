// The orthonormal, non-standard 2D Haar basis. GLSL twins: shaders/lib/haar_step.glsl,
// shaders/light_haar.comp.
//
// One level turns each 2×2 block [a b; c d] into
//   (a + b + c + d) / 2 at (x, y), (a - b + c - d) / 2 at (x + h, y),
//   (a + b - c - d) / 2 at (x, y + h), (a - b - c + d) / 2 at (x + h, y + h),
// with h half the side of the level's square; the next level works on the averages, until one is left
// (Stollnitz, DeRose, Salesin: Wavelets for Computer Graphics, 1995).
#pragma once

#include "engine/math/vector.h"

#include <cstddef>
#include <span>

namespace relume {

// Transforms one square of size × size values in place; `size` is a power of two.
void haarForward(std::span<vec3> values, int size);

// Inverts haarForward().
void haarInverse(std::span<vec3> values, int size);

// Transform each of the six faces of a cube, stored one after another, in place.
void haarForwardFaces(std::span<vec3> cube, int faceSize);
void haarInverseFaces(std::span<vec3> cube, int faceSize);

// Returns where the bake's kernels store the coefficient of index face · size² + y · size + x: at 16 · block
// + slot. GLSL twin: shaders/lib/haar_block.glsl.
size_t haarSlot(size_t coefficient, size_t size);

} // namespace relume
