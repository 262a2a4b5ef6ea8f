// Samples of a pixel in a visibility buffer of several, and which of them are shaded as one. Definitions of
// what shaders/lib/pixel_samples.glsl repeats.
#pragma once

#include "engine/math/vector.h"

#include <functional>
#include <span>
#include <vector>

namespace relume {

constexpr int kDefaultSamples = 4, kMostSamples = 8;

// Throws UsageError unless it is 1, 2, 4 or 8.
void expectSamples(int samples);

// Pixels from the upper left corner of the pixel: Vulkan's standard locations; the center of 1.
vec2 samplePosition(int samples, int i);

// Bits of the samples of each group that is shaded once, as what its first sample sees, at the mean of their
// positions: the first covered sample that is left, with those that `isOne` puts together with it. `seen`:
// the surface of every sample, 0 where none is.
std::vector<uint32_t> groupSamples(std::span<const uint32_t> seen,
                                   const std::function<bool(uint32_t, uint32_t)>& isOne);

} // namespace relume
