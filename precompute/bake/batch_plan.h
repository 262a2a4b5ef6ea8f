// How many points a submission bakes, from the device's limits.
#pragma once

#include "engine/vk/device.h"
#include "precompute/bake/bake_options.h"

namespace relume {

// Points of one submission: as many as the device's layers, storage-buffer range and a share of its memory
// allow for a part of `terms` terms, at most kMaxBatch. At least 1.
constexpr uint32_t kMaxBatch = 64;
uint32_t planBatch(const vk::Device& device, const BakeOptions& options, int terms);

} // namespace relume
