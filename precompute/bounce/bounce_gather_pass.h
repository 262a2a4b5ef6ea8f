// Gathers bounced light on the device; the host finds the hits.
#pragma once

#include "precompute/bounce/bounce_gather.h"
#include "precompute/transport/packing_pass.h"

namespace relume {

// Does what BounceGather does, with the same rows but for rounding.
class BounceGatherPass {
  public:
    // Keeps references to both. Throws OutOfMemory.
    BounceGatherPass(const vk::Device& device, const BounceHits& hits);

    // Returns the SPIR-V of its kernels.
    static std::vector<std::span<const uint32_t>> kernels();

    // Returns whether rows of so many entries at most can be gathered from on this device.
    static bool canGatherFrom(const vk::Device& device, uint64_t entries);

    // Does what BounceGather::gather() does. Throws OutOfMemory.
    std::vector<std::vector<SparseTransport>> gather(std::span<const SparseTransport> from,
                                                     const BounceReport& report);

    // Seconds of device time of everything gathered so far, by pass.
    const vk::PassTimes& times() const { return mCommands.times(); }

  private:
    struct Sources;
    struct HitBuffers;
    struct PartPass;

    const vk::Device& mDevice;
    const BounceHits& mHits;
    vk::Commands mCommands;
};

} // namespace relume
