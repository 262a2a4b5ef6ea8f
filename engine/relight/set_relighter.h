// The interface of relighters of one set of materials, which every layout of transport implements.
#pragma once

#include "engine/light/fill_light.h"
#include "engine/vk/commands.h"

#include <string>
#include <vector>

namespace relume {

// How tuples are updated when the light changes. All modes give the same bits. The rows layout always
// relights in full.
enum class RelightMode {
    Full,        // from all light entries
    Incremental, // from the changes since the light's last recording, if tuples are up to date with that
    Auto         // from whichever list of entries is shorter
};

// The light on the device, as recorded by LightTable (engine/render/light_table.h).
struct DeviceLight {
    const vk::Buffer& table;             // two halves: the light's entries, then its changes
    const vk::Buffer& stats;             // shared::LightStats
    uint64_t recording, recordingBefore; // numbers of this recording of light and of the one before
};

// Computes the tuples of one set of materials from transport and light.
class SetRelighter {
  public:
    // Tuples are kept of the first `lights` of LightPart. Throws OutOfMemory, or Error if the device cannot
    // bind as many tuples. Errors name part `name`.
    SetRelighter(const vk::Device& device, uint64_t rows, size_t lights, const std::string& name);
    virtual ~SetRelighter() = default;

    // Records the computation of the tuples of `lit` from the light recorded before.
    void record(vk::Commands& commands, const DeviceLight& light, RelightMode mode,
                LightPart lit = LightPart::Whole);

    size_t lights() const { return mLights.size(); }

    // Returns the number of buffers that the transport is divided into, so that each fits one binding.
    virtual size_t shards() const = 0;

    uint32_t rows() const { return mRows; }
    // Returns one vec3 per row, padded to 16 bytes; zero before the first record().
    const vk::Buffer& tuples(LightPart lit = LightPart::Whole) const { return mLights[size_t(lit)].tuples; }

  private:
    virtual void recordLayout(vk::Commands& commands, const DeviceLight& light, RelightMode mode,
                              LightPart lit) const = 0;

    struct KeptLight {
        vk::Buffer tuples;
        uint64_t recording = 0; // number of the light recording that the sums belong to
    };
    uint32_t mRows = 0;
    std::vector<KeptLight> mLights;
};

} // namespace relume
