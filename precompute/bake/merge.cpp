#include "precompute/bake/merge.h"

#include "engine/transport/asset_arrays.h"
#include "engine/transport/layout_chunks.h"
#include "engine/transport/visibility_chunk.h"
#include "precompute/bake/shard_difference.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

namespace {

void expectSameBake(const ShardFile& first, const ShardFile& other) {
    if (first.metaText() != other.metaText() || first.identity() != other.identity())
        throw Error(fmt::format(
            "{}: is a shard of another bake than {}: {}; bake all shards from the same inputs with the same "
            "options, program and kind of device",
            other.name(), first.name(), describeDifference(first, other)));
    if (first.shard().count != other.shard().count)
        throw Error(fmt::format("{}: is one of {} shards, and {} is one of {}; join shards of one division",
                                other.name(), other.shard().count, first.name(), first.shard().count));
}

// Returns all shards of one bake in order of index. Throws if one is missing or of another bake.
std::vector<const ShardFile*> inOrder(std::span<const ShardFile> shards) {
    if (shards.empty()) throw UsageError("expected the shards of a bake, found none");
    std::vector<const ShardFile*> ordered;
    for (const ShardFile& shard : shards) {
        expectSameBake(shards.front(), shard);
        ordered.push_back(&shard);
    }
    std::ranges::stable_sort(ordered, {}, [](const ShardFile* file) { return file->shard().index; });
    for (size_t i = 1; i < ordered.size(); i++)
        if (ordered[i]->shard() == ordered[i - 1]->shard())
            throw Error(fmt::format("{}: is shard {}/{}, and so is {}; name each shard once",
                                    ordered[i]->name(), ordered[i]->shard().index, ordered[i]->shard().count,
                                    ordered[i - 1]->name()));

    const uint32_t count = shards.front().shard().count;
    if (ordered.size() == count) return ordered;
    constexpr size_t kNamed = 8;
    std::string missing;
    size_t next = 0, named = 0;
    for (uint32_t index = 0; index < count && named < kNamed; index++) {
        if (next < ordered.size() && ordered[next]->shard().index == index) {
            next++;
            continue;
        }
        missing += fmt::format("{}{}/{}", named++ == 0 ? "" : ", ", index, count);
    }
    const size_t absent = count - ordered.size();
    throw Error(fmt::format("{} of {} shards missing: {}{}; bake them and name all parts", absent, count,
                            missing, absent > named ? ", …" : ""));
}

// The blocks of all shards, each read from its shard.
class ShardBlocks : public StoredBlocks {
  public:
    ShardBlocks(const BakePlan& plan, std::vector<const ShardFile*> shards)
        : mPlan(plan), mShards(std::move(shards)), mChunks(plan.blocks.size()), mLosses(plan.blocks.size()) {
        for (const ShardFile* shard : mShards) addShard(*shard);
    }

    const std::vector<ChunkEntry>& chunks(uint32_t block) const override { return mChunks[block]; }
    const TransportLosses& losses(uint32_t block) const override { return mLosses[block]; }
    std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const override;

  private:
    const ShardFile& fileOf(uint32_t block) const { return *mShards[block % mShards.size()]; }
    void addShard(const ShardFile& file);

    const BakePlan& mPlan;
    std::vector<const ShardFile*> mShards; // by index
    std::vector<std::vector<ChunkEntry>> mChunks;
    std::vector<TransportLosses> mLosses;
};

void ShardBlocks::addShard(const ShardFile& file) {
    const auto blocks = uint32_t(mPlan.blocks.size());
    const std::vector<TransportLosses> losses = file.losses(file.shard().size(blocks));
    size_t used = 0;
    for (uint32_t block = file.shard().index; block < blocks; block += file.shard().count) {
        mLosses[block] = losses[block / file.shard().count];
        for (size_t chunk = 0; chunk < chunksOf(mPlan, block); chunk++) {
            const ChunkEntry expected = expectedChunk(mPlan, block, chunk);
            used += expected.tag != kVisibility;
            const ChunkEntry* entry = file.chunks().findRun(expected.tag, expected.owner, expected.run);
            if (!entry || !isPlausible(mPlan, block, chunk, *entry))
                throw Error(
                    fmt::format("{}: chunk {} of {} {}, run {}, is missing or of a wrong size; bake the "
                                "shard again",
                                file.name(), tagText(expected.tag),
                                expected.tag == kVisibility ? "part" : "set", expected.owner, expected.run));
            mChunks[block].push_back(*entry);
        }
    }
    const auto found = size_t(std::ranges::count_if(
        file.chunks().entries(), [](const ChunkEntry& entry) { return isLayoutTag(entry.tag); }));
    if (found != used)
        throw Error(fmt::format(
            "{}: holds {} chunks of transport, and shard {}/{} has {}: others' blocks are in it; bake "
            "the shard again",
            file.name(), found, file.shard().index, file.shard().count, used));
}

// Checks everything that a reader of the whole file would refuse.
std::vector<std::byte> ShardBlocks::load(uint32_t block, const ChunkEntry& entry) const {
    const ShardFile& file = fileOf(block);
    std::vector<std::byte> stored = file.chunks().loadStored(entry);
    const BakeBlock& place = mPlan.blocks[block];
    if (entry.tag == kVisibility) {
        decodeVisibility(
            unpackChunk(entry, stored, file.name()),
            std::min(mPlan.visibilityRun, place.end - entry.run * mPlan.visibilityRun),
            uint32_t(mPlan.asset.visibilitySize),
            fmt::format("{}: chunk visb of part {}, run {}", file.name(), entry.owner, entry.run));
        return stored;
    }
    const MaterialSet& set = mPlan.asset.parts[place.part].sets[entry.owner - mPlan.firstSet[place.part]];
    const Asset& asset = mPlan.asset;
    const RowLimits limits{uint32_t(6 * asset.faceSize * asset.faceSize), uint64_t(asset.coefficients)};
    const std::vector<std::byte> raw = unpackChunk(entry, stored, file.name());
    std::visit(
        [&](const auto& layout) {
            checkChunk(layout, {place.first, place.count(), entry.run}, raw, limits,
                       whereOf(file.chunks(), entry, "set"));
        },
        set.transport);
    return stored;
}

} // namespace

uint64_t mergeShards(std::span<const ShardFile> shards, const ChunkWriter::Output& output) {
    const std::vector<const ShardFile*> ordered = inOrder(shards);
    BakePlan plan = ordered.front()->plan();
    const ShardBlocks blocks(plan, ordered);
    writeBake(plan, blocks, output);
    return plan.vertices();
}

} // namespace relume
