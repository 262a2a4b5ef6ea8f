// Samples of a pixel in a multisampled visibility buffer, and which of them are shaded together. CPU
// definitions of what shaders/lib/pixel_samples.glsl repeats.
#pragma once

#include "engine/math/vector.h"

#include <functional>
#include <span>
#include <vector>

namespace relume {

constexpr int kDefaultSamples = 4, kMostSamples = 8;

// Throws UsageError unless `samples` is 1, 2, 4 or 8.
void expectSamples(int samples);

// Returns the position of sample i, in pixels from the pixel's upper left corner: Vulkan's standard
// locations, or the center for one sample.
vec2 samplePosition(int samples, int i);

// Groups the samples of a pixel. Returns a bit mask per group, which is shaded once, for the triangle of its
// first sample, at the mean of its samples' positions. A group starts with the first covered sample that is
// left and takes those that `isOne` accepts with it. `seen` has the triangle id of every sample, 0 for none.
std::vector<uint32_t> groupSamples(std::span<const uint32_t> seen,
                                   const std::function<bool(uint32_t, uint32_t)>& isOne);

} // namespace relume
