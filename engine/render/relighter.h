// Light change, second half: the K-tuple of every vertex, on the device.
#pragma once

#include "engine/render/appearance.h"
#include "engine/render/light_pass.h"
#include "engine/transport/asset.h"

#include <limits>

namespace relume {

struct RelighterOptions {
    // Bytes of the largest buffer of transport; the device's own limit holds as well.
    uint64_t largestShard = std::numeric_limits<uint64_t>::max();
};

// Holds the transport of every part and set of materials on the device, as shards of whole rows that fit a
// binding. Entries come in groups of eight, 48 bytes: four words of two 16-bit indices each (lower half
// first), then eight words of packed 11/11/10 values. Rows are padded to whole groups with zeros.
class Relighter {
  public:
    // Throws OutOfMemory, or Error when a part has more rows than the device can bind tuples for.
    Relighter(const vk::Device& device, const Asset& asset, const RelighterOptions& options = {});

    // Pass "relight": tuples of every part's worn set (none given: the first) under the light recorded
    // before. Draws may use them at once. Those of other sets stay as they are.
    void record(vk::Commands& commands, const LightPass& light, const Appearance& appearance = {}) const;

    size_t parts() const { return mParts.size(); }
    size_t shards(size_t part, size_t set = 0) const { return mParts[part][set].shards.size(); }
    // vec3 per row, row = vertex · terms + term: what the light gives of a term, the γ of the method.
    const vk::Buffer& tuples(size_t part, size_t set = 0) const { return mParts[part][set].tuples; }

    // Those of the last submission. Waits for the device.
    std::vector<vec3> readTuples(size_t part, size_t set = 0) const;

  private:
    struct Shard {
        uint32_t firstRow = 0, rows = 0;
        vk::Buffer starts;  // rows + 1: first group of each row
        vk::Buffer entries; // groups
    };
    struct Set {
        uint32_t rows = 0;
        std::vector<Shard> shards;
        vk::Buffer scales; // of rows
        vk::Buffer tuples;
    };

    uint32_t largestRowCount(uint64_t largestShard) const;
    Set makeSet(const SparseTransport& transport, const std::string& name,
                const RelighterOptions& options) const;

    const vk::Device& mDevice;
    int mFaceSize;
    vk::ComputeProgram mProgram;
    std::vector<std::vector<Set>> mParts; // sets by part
};

} // namespace relume
