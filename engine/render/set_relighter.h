// Relights one set of a part's materials: what every layout of transport implements.
#pragma once

#include "engine/render/light_pass.h"

namespace relume {

class SetRelighter {
  public:
    // Throws OutOfMemory, or Error when the device cannot bind as many tuples. `name` stands for the part.
    SetRelighter(const vk::Device& device, uint64_t rows, const std::string& name);
    virtual ~SetRelighter() = default;

    // Writes the tuples under the light recorded before.
    virtual void record(vk::Commands& commands, const LightPass& light) const = 0;

    // Buffers that the transport is divided into, for what one binding holds.
    virtual size_t shards() const = 0;

    uint32_t rows() const { return mRows; }
    const vk::Buffer& tuples() const { return mTuples; } // vec3 per row

  private:
    uint32_t mRows = 0;
    vk::Buffer mTuples;
};

} // namespace relume
