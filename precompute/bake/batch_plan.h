// Sizes a batch by the limits of the device.
#pragma once

#include "engine/vk/device.h"
#include "precompute/bake/bake_options.h"

namespace relume {

// Limits that a user sets on a bake.
struct BakeLimits {
    uint64_t memory = 0; // for a batch, device and host together, in bytes; 0: chosen by planBatch()
};

// Returns the number of points per submission for a part whose vertices have `terms` rows of `entries`
// entries in all, at least 1: the most that the device's layer count, storage-buffer range and a share of its
// memory allow, but no more than keep it busy. Throws UsageError if `limits` leave no room for one point.
uint32_t planBatch(const vk::Device& device, const BakeOptions& options, int terms, uint64_t entries,
                   const BakeLimits& limits = {});

} // namespace relume
