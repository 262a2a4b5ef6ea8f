// How fast memory is copied here and now: the floor under every stage that is bound by memory.
#pragma once

#include "engine/vk/device.h"

namespace relume {

// Bytes read and written per second, together: the best of a few copies of buffers beyond any cache but the
// largest.
double deviceCopyBandwidth(const vk::Device& device);
double hostCopyBandwidth(int threads);

} // namespace relume
