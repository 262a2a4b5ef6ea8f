// Relighting of clusters: columns that the light does not meet are not read.
#pragma once

#include "engine/render/set_relighter.h"
#include "engine/transport/clustered_transport.h"

namespace relume {

// The transport is divided into shards of whole groups, a cluster and a term each.
class ClustersRelighter : public SetRelighter {
  public:
    // As RowsRelighter.
    ClustersRelighter(const vk::Device& device, const vk::ComputeProgram& program,
                      const ClusteredTransport& transport, uint32_t coefficients, uint64_t largestShard,
                      const std::string& name);
    static vk::ComputeProgram makeProgram(const vk::Device& device);

    size_t shards() const override { return mShards.size(); }

  private:
    void recordLayout(vk::Commands& commands, const LightPass& light, RelightMode mode) const override;

    struct Shard {
        uint32_t firstGroup = 0, groups = 0;
        vk::Buffer starts;  // groups + 1: first column of each
        vk::Buffer indices; // of columns, two a word
        vk::Buffer columns; // a word a vertex
    };

    const vk::ComputeProgram& mProgram;
    uint32_t mTerms, mVertices;
    std::vector<Shard> mShards;
    vk::Buffer mScales; // of rows
    vk::Buffer mSums;   // ivec3 per row
};

} // namespace relume
