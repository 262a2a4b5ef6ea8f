#include "engine/render/clusters_relighter.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"
#include "shaders/relight_clusters_comp.h"
#include "shaders/shared/render.h"

#include <algorithm>

namespace relume {

namespace {

constexpr uint32_t kLeastLanes = 8, kMostLanes = 64; // of the shader
constexpr uint64_t kColumnBytes = kClusterVertices * sizeof(uint32_t);

std::vector<uint32_t> inPairs(std::span<const uint16_t> indices, uint32_t coefficients) {
    std::vector<uint32_t> words((indices.size() + 1) / 2, 0);
    for (size_t i = 0; i < indices.size(); i++) {
        RELUME_CHECK_LT(uint32_t(indices[i]), coefficients);
        words[i / 2] |= uint32_t(indices[i]) << i % 2 * 16;
    }
    return words;
}

} // namespace

vk::ComputeProgram ClustersRelighter::makeProgram(const vk::Device& device) {
    const uint32_t lanes = device.info().subgroupSize;
    if (!device.info().subgroupBallot || lanes % kLeastLanes != 0 || lanes > kMostLanes)
        throw Error(
            "{}: relighting clusters needs subgroups of {} to {} invocations that can vote; convert the "
            "bake to rows: `relume convert --layout rows`",
            device.name(), kLeastLanes, kMostLanes);
    return {device,
            relight_clusters_comp_spirv,
            {lanes},
            "relight clusters",
            vk::ComputeProgram::Subgroups::Full};
}

ClustersRelighter::ClustersRelighter(const vk::Device& device, const vk::ComputeProgram& program,
                                     const ClusteredTransport& transport, uint32_t coefficients,
                                     uint64_t largestShard, const std::string& name)
    : SetRelighter(device, transport.rows(), name), mProgram(program), mTerms(transport.terms),
      mVertices(transport.vertices),
      mScales(vk::upload<float>(device, transport.scales, name + " row scales")) {
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

void ClustersRelighter::record(vk::Commands& commands, const LightPass& light) const {
    for (const Shard& shard : mShards)
        commands.dispatch(
            mProgram,
            {shard.starts, shard.indices, shard.columns, light.table(), light.stats(), mScales, tuples()},
            shared::RelightClustersPush{shard.firstGroup, mTerms, mVertices},
            {shard.groups * mProgram.groupSize()[0], 1, 1});
}

} // namespace relume
