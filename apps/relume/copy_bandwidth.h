// Measures the bandwidth of copies, which bounds every memory-bound stage.
#pragma once

#include "engine/vk/device.h"

namespace relume {

// Returns bytes read plus bytes written per second: the best of a few copies of buffers larger than all but
// the largest caches.
double deviceCopyBandwidth(const vk::Device& device);
double hostCopyBandwidth(int threads);

} // namespace relume
