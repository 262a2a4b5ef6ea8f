#include "engine/render/relighter.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"
#include "shaders/relight_comp.h"
#include "shaders/shared/render.h"

#include <algorithm>

namespace relume {

using vk::Stage;

namespace {

constexpr uint64_t kEntriesPerGroup = 8;
constexpr uint64_t kWordsPerGroup = 12;
constexpr uint64_t kGroupBytes = kWordsPerGroup * sizeof(uint32_t);

struct ShardData {
    std::vector<uint32_t> starts{0};
    std::vector<uint32_t> words;
};

uint64_t rowGroups(const SparseTransport& transport, size_t row) {
    const uint64_t entries = transport.rowStarts[row + 1] - transport.rowStarts[row];
    return (entries + kEntriesPerGroup - 1) / kEntriesPerGroup;
}

void appendRow(ShardData& shard, const SparseTransport& transport, size_t row, uint32_t coefficients) {
    const size_t firstWord = shard.words.size();
    shard.words.resize(firstWord + rowGroups(transport, row) * kWordsPerGroup, 0);
    const uint64_t start = transport.rowStarts[row], end = transport.rowStarts[row + 1];
    for (uint64_t entry = start; entry < end; entry++) {
        const uint64_t place = (entry - start) % kEntriesPerGroup;
        uint32_t* group = &shard.words[firstWord + (entry - start) / kEntriesPerGroup * kWordsPerGroup];
        RELUME_CHECK_LT(uint32_t(transport.indices[entry]), coefficients);
        group[place / 2] |= uint32_t(transport.indices[entry]) << (place % 2 * 16);
        group[4 + place] = transport.values[entry];
    }
    shard.starts.push_back(uint32_t(shard.words.size() / kWordsPerGroup));
}

} // namespace

Relighter::Relighter(const vk::Device& device, const Asset& asset, const RelighterOptions& options)
    : mDevice(device), mFaceSize(asset.faceSize), mProgram(device, relight_comp_spirv, {}, "relight") {
    for (const AssetPart& part : asset.parts) {
        std::vector<Set>& sets = mParts.emplace_back();
        for (const MaterialSet& set : part.sets) sets.push_back(makeSet(set.transport, part.name, options));
    }
}

// Rows of a shard: as many as one dispatch reaches and as fit the buffer of their starts.
uint32_t Relighter::largestRowCount(uint64_t largestShard) const {
    const uint64_t reached =
        uint64_t(mDevice.limits().maxComputeWorkGroupCount[0]) * uint64_t(mProgram.groupSize()[0]);
    const uint64_t bound = std::max<uint64_t>(largestShard / sizeof(uint32_t), 2) - 1;
    return uint32_t(std::min<uint64_t>({reached, bound, std::numeric_limits<uint32_t>::max()}));
}

Relighter::Set Relighter::makeSet(const SparseTransport& transport, const std::string& name,
                                  const RelighterOptions& options) const {
    const uint64_t tupleBytes = std::max<uint64_t>(transport.rows() * sizeof(vec3), sizeof(vec3));
    if (tupleBytes > mDevice.largestStorageBuffer())
        throw Error("{}: {} vertices with {} terms need {} bytes of tuples; {} binds at most {}; split the "
                    "mesh into several parts",
                    name, transport.vertices, transport.terms, tupleBytes, mDevice.name(),
                    mDevice.largestStorageBuffer());
    Set set;
    set.rows = uint32_t(transport.rows());
    set.tuples = vk::Buffer(mDevice, tupleBytes, vk::BufferUse::Device, name + " tuples");
    set.scales = vk::upload<float>(mDevice, transport.scales, name + " row scales");

    const uint64_t largestShard = std::min(options.largestShard, mDevice.largestStorageBuffer());
    const uint64_t largestGroups = largestShard / kGroupBytes;
    const uint32_t largestRows = largestRowCount(largestShard);
    const uint32_t coefficients = 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize);
    for (uint32_t row = 0; row < set.rows;) {
        Shard& shard = set.shards.emplace_back();
        shard.firstRow = row;
        ShardData data;
        // At least one row: the longest, all 24,576 coefficients, is far below what any device binds.
        do appendRow(data, transport, row++, coefficients);
        while (row < set.rows && data.starts.size() <= largestRows &&
               data.starts.back() + rowGroups(transport, row) <= largestGroups);
        shard.rows = row - shard.firstRow;
        shard.starts = vk::upload<uint32_t>(mDevice, data.starts, name + " row starts");
        shard.entries = vk::upload<uint32_t>(mDevice, data.words, name + " entries");
    }
    return set;
}

void Relighter::record(vk::Commands& commands, const LightPass& light, const Appearance& appearance) const {
    RELUME_CHECK(appearance.empty() || appearance.size() == mParts.size());
    RELUME_CHECK_EQ(light.faceSize(), mFaceSize);
    // An earlier frame of the same submission may still be reading the tuples.
    commands.barrier(Stage::Draw, Stage::Compute);
    commands.pass("relight", [&] {
        for (size_t part = 0; part < mParts.size(); part++) {
            const Set& set = mParts[part].at(appearance.empty() ? 0 : appearance[part].set);
            for (const Shard& shard : set.shards)
                commands.dispatch(
                    mProgram,
                    {shard.starts, shard.entries, light.table(), light.scale(), set.scales, set.tuples},
                    shared::RelightPush{shard.firstRow, shard.rows}, {shard.rows, 1, 1});
        }
        commands.barrier(Stage::Compute, Stage::Draw);
    });
}

std::vector<vec3> Relighter::readTuples(size_t part, size_t set) const {
    return vk::download<vec3>(mDevice, mParts[part][set].tuples, mParts[part][set].rows);
}

} // namespace relume
