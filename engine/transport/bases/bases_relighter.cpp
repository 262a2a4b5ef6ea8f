#include "engine/transport/bases/bases_relighter.h"

#include "engine/base/check.h"
#include "engine/math/divide_up.h"
#include "engine/vk/upload.h"
#include "shaders/relight_combine_comp.h"
#include "shaders/relight_project_comp.h"
#include "shaders/shared/render.h"

#include <algorithm>

namespace relume {

using vk::Stage;

namespace {

constexpr uint32_t kWordsPerGroup = 16; // per column
constexpr uint32_t kVerticesPerLane = 8;

// Puts a byte into a word at `place`; 0 is the lowest byte.
void putByte(uint32_t& word, size_t place, int8_t value) { word |= uint32_t(uint8_t(value)) << 8 * place; }

// Packs column indices, all below `coefficients`, two per word.
std::vector<uint32_t> inPairs(std::span<const uint16_t> indices, uint32_t coefficients) {
    std::vector<uint32_t> words((indices.size() + 1) / 2, 0);
    for (size_t i = 0; i < indices.size(); i++) {
        RELUME_CHECK_LT(uint32_t(indices[i]), coefficients);
        words[i / 2] |= uint32_t(indices[i]) << i % 2 * 16;
    }
    return words;
}

// Returns the mode as push constants encode it.
uint32_t pushed(RelightMode mode) {
    switch (mode) {
    case RelightMode::Full:
        return shared::kRelightFull;
    case RelightMode::Incremental:
        return shared::kRelightIncremental;
    case RelightMode::Auto:
        break;
    }
    return shared::kRelightAuto;
}

} // namespace

// Clusters being prepared for upload.
class BasesRelighter::ShardData {
  public:
    std::vector<shared::BasisGroup> groups;
    std::vector<shared::BasisVertices> clusters;
    std::vector<shared::BasisWeighting> weightings;
    std::vector<uint16_t> indices;
    std::vector<uint32_t> basis, weights;
    std::vector<float> scales;
    uint32_t components = 0; // of all clusters, each padded to whole words

    // Returns the size of the largest buffer if this cluster were added.
    uint64_t bytesWith(const BasisTransport& transport, size_t cluster) const {
        const BasisCluster& more = transport.clusters[cluster];
        const uint64_t words = divideUp(more.components, 4);
        const uint64_t octets = divideUp(transport.verticesOf(cluster), kVerticesPerLane);
        return 4 * std::max({basis.size() + words * more.columns(), (indices.size() + more.columns() + 1) / 2,
                             (weightings.size() + transport.kinds.size()) * 3,
                             weights.size() + octets * more.scales.size() * 2, (components + 4 * words) * 4});
    }

    void add(const BasisTransport& transport, size_t number) {
        const BasisCluster& from = transport.clusters[number];
        const uint32_t words = divideUp(from.components, 4);
        clusters.push_back({uint32_t(number * kBasisVertices), transport.verticesOf(number), components});
        for (uint32_t word = 0; word < words; word += kWordsPerGroup)
            groups.push_back({uint32_t(indices.size()), uint32_t(from.columns()), uint32_t(basis.size()),
                              words, word, components, uint32_t(clusters.size() - 1)});
        components += 4 * words;
        addBasis(from, words);
        addWeights(from, transport.verticesOf(number));
    }

  private:
    void addBasis(const BasisCluster& from, uint32_t words) {
        for (size_t column = 0; column < from.columns(); column++) {
            indices.push_back(from.indices[column]);
            const size_t first = basis.size();
            basis.resize(first + words, 0);
            for (size_t i = 0; i < from.components; i++)
                putByte(basis[first + i / 4], i % 4, from.basis[column * from.components + i]);
        }
    }

    void addWeights(const BasisCluster& from, uint32_t vertices) {
        size_t kindWeights = 0;
        for (const size_t count : from.counts) {
            weightings.push_back({uint32_t(weights.size() / 2), uint32_t(scales.size()), uint32_t(count)});
            scales.insert(scales.end(), count, 0);
            for (size_t first = 0; first < vertices; first += kVerticesPerLane)
                for (size_t i = 0; i < count; i++) {
                    uint32_t halves[2] = {0, 0};
                    for (size_t v = 0; v < std::min<size_t>(kVerticesPerLane, vertices - first); v++)
                        putByte(halves[v / 4], v % 4, from.weights[kindWeights + (first + v) * count + i]);
                    weights.insert(weights.end(), halves, halves + 2);
                }
            kindWeights += count * vertices;
        }
        std::ranges::copy(from.scales, scales.end() - ptrdiff_t(from.scales.size()));
    }
};

BasesRelighter::BasesRelighter(const vk::Device& device, const BasisTransport& transport,
                               uint32_t coefficients, size_t lights, uint64_t largestShard,
                               const std::string& name)
    : SetRelighter(device, transport.rows(), lights, name), mTerms(transport.terms),
      mKinds(uint32_t(transport.kinds.size())) {
    const vk::DeviceInfo& info = device.info();
    const bool isPortable = info.takesPortableShaders();
    // A subgroup; 8 or 32 invocations for portable shaders.
    const uint32_t lanes = !isPortable ? info.subgroupSize : info.isSoftware ? 8 : 32;
    using enum vk::Subgroups;
    mProject = {device, relight_project_comp_spirv, {lanes}, "relight project", isPortable ? Any : Full};
    mCombine = {device, relight_combine_comp_spirv, {lanes}, "relight combine"};
    mGroupsPerTerm = divideUp(kBasisVertices / kVerticesPerLane, lanes);

    std::vector<shared::BasisTermKinds> termKinds(mTerms, {0, 0});
    std::vector<vec3> colors;
    for (uint32_t kind = 0; kind < mKinds; kind++) {
        auto& [first, count] = termKinds[transport.kinds[kind].term];
        if (count++ == 0) first = kind;
        colors.push_back(transport.kinds[kind].color);
    }
    mTermKinds = vk::upload<shared::BasisTermKinds>(device, termKinds, name + " kinds of terms");
    mColors = vk::upload<vec3>(device, colors, name + " colors of kinds");

    // The smallest texels that relight_combine reads take one word.
    largestShard = std::min(largestShard, sizeof(float) * device.mostTexels(sizeof(float)));
    constexpr uint32_t kMostGroups = kMostBasisComponents / (4 * kWordsPerGroup); // per cluster
    const size_t mostClusters =
        device.limits().maxComputeWorkGroupCount[0] / std::max(mTerms * mGroupsPerTerm, kMostGroups);
    for (size_t cluster = 0; cluster < transport.clusters.size();) {
        ShardData data;
        do data.add(transport, cluster++);
        while (cluster < transport.clusters.size() && data.clusters.size() < mostClusters &&
               data.bytesWith(transport, cluster) <= largestShard);
        mShards.push_back(upload(device, data, coefficients, name));
    }
}

BasesRelighter::Shard BasesRelighter::upload(const vk::Device& device, const ShardData& data,
                                             uint32_t coefficients, const std::string& name) const {
    const uint64_t components = std::max<uint64_t>(data.components, 1);
    std::vector<Projected> projected;
    for (size_t light = 0; light < lights(); light++)
        projected.push_back(
            {vk::Buffer(device, components * sizeof(ivec3), vk::BufferUse::Device, name + " projection sums"),
             vk::Buffer(device, components * sizeof(vec4), vk::BufferUse::Device, name + " projections"),
             vk::upload<uint32_t>(device, std::vector<uint32_t>(data.clusters.size(), 0), name + " stamps")});
    return {uint32_t(data.clusters.size()),
            uint32_t(data.groups.size()),
            vk::upload<shared::BasisGroup>(device, data.groups, name + " basis groups"),
            vk::upload<uint32_t>(device, inPairs(data.indices, coefficients), name + " column indices"),
            vk::upload<uint32_t>(device, data.basis, name + " basis"),
            vk::upload<shared::BasisVertices>(device, data.clusters, name + " clusters"),
            vk::upload<shared::BasisWeighting>(device, data.weightings, name + " weightings"),
            vk::upload<uint32_t>(device, data.weights, name + " weights"),
            vk::upload<float>(device, data.scales, name + " weight scales"),
            std::move(projected)};
}

void BasesRelighter::recordLayout(vk::Commands& commands, const DeviceLight& light, RelightMode mode,
                                  LightPart lit) const {
    const auto stamp = uint32_t(light.recording);
    const auto of = [&](const Shard& shard) -> const Projected& { return shard.projected[size_t(lit)]; };
    for (const Shard& shard : mShards)
        if (shard.groups > 0)
            commands.dispatch(mProject,
                              {shard.indices, light.table, light.stats, shard.groupList, shard.basis,
                               of(shard).sums, of(shard).projections, of(shard).stamps},
                              shared::RelightProjectPush{pushed(mode), stamp},
                              {shard.groups * mProject.groupSize()[0], 1, 1});
    commands.barrier(Stage::Compute, Stage::Compute);
    for (const Shard& shard : mShards)
        commands.dispatch(mCombine,
                          {shard.clusterList, mTermKinds, mColors, shard.weightings,
                           vk::Binding::texelsOf(shard.weights, VK_FORMAT_R32G32_UINT),
                           vk::Binding::texelsOf(shard.scales, VK_FORMAT_R32_SFLOAT),
                           vk::Binding::texelsOf(of(shard).projections, VK_FORMAT_R32G32B32A32_SFLOAT),
                           tuples(lit), of(shard).stamps},
                          shared::RelightCombinePush{mTerms, mKinds, mGroupsPerTerm, stamp},
                          {shard.clusters * mTerms * mGroupsPerTerm * mCombine.groupSize()[0], 1, 1});
}

} // namespace relume
