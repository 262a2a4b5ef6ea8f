// Relights one set of a part's materials: what every layout of transport implements.
#pragma once

#include "engine/vk/commands.h"

namespace relume {

// How tuples follow a light that changes. All give the same bits.
enum class RelightMode {
    Full,        // from all of the light
    Incremental, // from what changed since the light recorded before, wherever sums of that light are there
    Auto         // by whichever is less
};

// The light on the device, as LightPass (engine/render/light_pass.h) has recorded it.
struct DeviceLight {
    const vk::Buffer& table; // two halves: the light, then how it changed
    const vk::Buffer& stats; // shared::LightStats
    uint64_t recording, recordingBefore;
};

class SetRelighter {
  public:
    // Throws OutOfMemory, or Error when the device cannot bind as many tuples. `name` stands for the part.
    SetRelighter(const vk::Device& device, uint64_t rows, const std::string& name);
    virtual ~SetRelighter() = default;

    // Writes the tuples under the light recorded before.
    void record(vk::Commands& commands, const DeviceLight& light, RelightMode mode);

    // Buffers that the transport is divided into, for what one binding holds.
    virtual size_t shards() const = 0;

    uint32_t rows() const { return mRows; }
    const vk::Buffer& tuples() const { return mTuples; } // vec3 per row; zero before the first record()

  private:
    virtual void recordLayout(vk::Commands& commands, const DeviceLight& light, RelightMode mode) const = 0;

    uint32_t mRows = 0;
    vk::Buffer mTuples;
    uint64_t mRecording = 0; // of the light that the sums are of
};

} // namespace relume
