// Relighting of bases: projects the light onto each cluster's basis vectors, then combines the projections by
// the weights of its rows.
#pragma once

#include "engine/relight/set_relighter.h"
#include "engine/transport/bases/basis_transport.h"

namespace relume {

// Relights transport in bases. It is divided into shards of whole clusters. Basis values are packed four
// components to a word, columns padded to whole words. Weights are stored as octets, the 8 bytes of eight
// vertices for one component: octets component after component, then for the next eight vertices, then for
// the next kind; incomplete octets are padded.
class BasesRelighter : public SetRelighter {
  public:
    // See RowsRelighter.
    BasesRelighter(const vk::Device& device, const BasisTransport& transport, uint32_t coefficients,
                   size_t lights, uint64_t largestShard, const std::string& name);

    size_t shards() const override { return mShards.size(); }

  private:
    void recordLayout(vk::Commands& commands, const DeviceLight& light, RelightMode mode,
                      LightPart lit) const override;

    // A light projected on the basis vectors of a shard.
    struct Projected {
        vk::Buffer sums, projections, stamps;
    };
    struct Shard {
        uint32_t clusters = 0, groups = 0;
        vk::Buffer groupList, indices, basis;                // relight_project.comp
        vk::Buffer clusterList, weightings, weights, scales; // relight_combine.comp
        std::vector<Projected> projected;                    // by light
    };
    class ShardData;
    Shard upload(const vk::Device& device, const ShardData& data, uint32_t coefficients,
                 const std::string& name) const;

    vk::ComputeProgram mProject, mCombine;
    uint32_t mTerms, mKinds, mGroupsPerTerm;
    vk::Buffer mTermKinds, mColors;
    std::vector<Shard> mShards;
};

} // namespace relume
