#include "engine/render/clusters_relighter.h"

#include "engine/render/column_listing.h"
#include "engine/vk/upload.h"
#include "shaders/relight_clusters_comp.h"
#include "shaders/shared/render.h"

#include <algorithm>

namespace relume {

namespace {

constexpr uint64_t kColumnBytes = kClusterVertices * sizeof(uint32_t);

} // namespace

vk::ComputeProgram ClustersRelighter::makeProgram(const vk::Device& device) {
    return makeListingProgram(device, relight_clusters_comp_spirv, "relight clusters");
}

ClustersRelighter::ClustersRelighter(const vk::Device& device, const vk::ComputeProgram& program,
                                     const ClusteredTransport& transport, uint32_t coefficients,
                                     uint64_t largestShard, const std::string& name)
    : SetRelighter(device, transport.rows(), name), mProgram(program), mTerms(transport.terms),
      mVertices(transport.vertices),
      mScales(vk::upload<float>(device, transport.scales, name + " row scales")),
      mSums(device, std::max(1u, rows()) * sizeof(ivec3), vk::BufferUse::Device, name + " sums") {
    const auto groups = uint32_t(transport.groups());
    const uint64_t mostColumns = largestShard / kColumnBytes;
    const uint32_t mostGroups = device.limits().maxComputeWorkGroupCount[0];
    for (uint32_t group = 0; group < groups;) {
        Shard& shard = mShards.emplace_back();
        shard.firstGroup = group;
        const uint64_t first = transport.columnStarts[group];
        // At least one group: even all 24,576 columns are far below what any device binds.
        std::vector<uint32_t> starts{0};
        do starts.push_back(uint32_t(transport.columnStarts[++group] - first));
        while (group < groups && group - shard.firstGroup < mostGroups &&
               transport.columnStarts[group + 1] - first <= mostColumns);
        shard.groups = group - shard.firstGroup;
        shard.starts = vk::upload<uint32_t>(device, starts, name + " column starts");
        shard.indices = vk::upload<uint32_t>(
            device, inPairs(std::span(transport.indices).subspan(first, starts.back()), coefficients),
            name + " column indices");
        shard.columns = vk::upload<uint32_t>(
            device,
            std::span(transport.values).subspan(first * kClusterVertices, starts.back() * kClusterVertices),
            name + " columns");
    }
}

void ClustersRelighter::recordLayout(vk::Commands& commands, const LightPass& light, RelightMode mode) const {
    for (const Shard& shard : mShards)
        commands.dispatch(mProgram,
                          {shard.indices, light.table(), light.stats(), shard.starts, shard.columns, mScales,
                           mSums, tuples()},
                          shared::RelightClustersPush{shard.firstGroup, mTerms, mVertices, pushed(mode)},
                          {shard.groups * mProgram.groupSize()[0], 1, 1});
}

} // namespace relume
