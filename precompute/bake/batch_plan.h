// How many points a submission bakes, from the device's limits.
#pragma once

#include "engine/vk/device.h"
#include "precompute/bake/bake_options.h"

namespace relume {

// What a user lets a bake take.
struct BakeLimits {
    uint64_t memory = 0; // bytes of a batch, on device and host together; 0: as planBatch() finds right
};

// Points of one submission: as many as the device's layers, storage-buffer range and a share of its memory
// allow for a part of `terms` terms, and no more than keep it busy. At least 1. Throws UsageError when
// `limits` leaves no room for a single one.
uint32_t planBatch(const vk::Device& device, const BakeOptions& options, int terms,
                   const BakeLimits& limits = {});

} // namespace relume
