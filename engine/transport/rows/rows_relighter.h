// Relighting of rows: sums the products of row entries and light entries.
#pragma once

#include "engine/relight/set_relighter.h"
#include "engine/transport/rows/sparse_transport.h"

namespace relume {

// Relights transport in rows. It is divided into shards of whole rows. Entries are packed in groups of eight,
// 48 bytes: four words of two 16-bit indices each (lower half first), then eight words of packed 11/11/10
// values. Rows are padded to whole groups with zeros.
class RowsRelighter : public SetRelighter {
  public:
    // `coefficients` is the light's, 6 F²; all indices must be below it; `lights` as of SetRelighter.
    // `largestShard` limits a shard's bytes; a shard has at least one row.
    RowsRelighter(const vk::Device& device, const SparseTransport& transport, uint32_t coefficients,
                  size_t lights, uint64_t largestShard, const std::string& name);

    size_t shards() const override { return mShards.size(); }

  private:
    // Ignores the mode and relights in full: to find the changed entries it would have to read all indices.
    void recordLayout(vk::Commands& commands, const DeviceLight& light, RelightMode,
                      LightPart lit) const override;

    struct Shard {
        uint32_t firstRow = 0, rows = 0;
        vk::Buffer starts;  // rows + 1: first group of each row
        vk::Buffer entries; // groups
    };

    vk::ComputeProgram mRelight;
    std::vector<Shard> mShards;
    vk::Buffer mScales; // per row
};

} // namespace relume
