// A bake in shards, made up without a device.
#pragma once

#include "precompute/bake/merge.h"
#include "precompute/layout/layouts.h"
#include "tests/support/asset_sample.h"

namespace relume::test {

// Two parts, the first with two sets; with no other numbers of vertices, of five and of two blocks.
inline Asset shardedAsset(uint32_t first = 300, uint32_t second = 70) {
    std::mt19937 random(5);
    Asset asset = sampleAsset();
    asset.truncationError = asset.quantizationError = 0;
    asset.parts = {samplePart(first, 3, asset.faceSize, 4, random),
                   samplePart(second, 1, asset.faceSize, 3, random)};
    asset.parts[0].sets.push_back(samplePart(first, 2, asset.faceSize, 5, random).sets[0]);
    asset.parts[0].sets[1].materials[0].name = "other";
    return asset;
}

// The plan of such an asset's bake, its transport in this layout.
inline BakePlan planIn(Asset asset, TransportLayout layout) {
    size_t sets = 0;
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) {
            sets++;
            if (layout == TransportLayout::Rows) continue;
            asset.layout = recordOf({.layout = layout}, 0);
            set.transport =
                emptyTransport(layout, uint32_t(part.mesh.vertexCount()), uint32_t(set.brdf.terms));
            std::visit([&](auto& own) { prepareLayout(own, set.brdf, false); }, set.transport);
        }
    BakePlan plan = planOf(std::move(asset));
    if (layout != TransportLayout::Rows) plan.scale = LayoutScale{std::vector<float>(sets, 1.0f), 1e-4};
    return plan;
}

// A block of an asset in rows, with losses as a device might measure them.
inline BakedBlock bakedBlock(const BakePlan& plan, const Asset& asset, uint32_t number) {
    const BakeBlock& place = plan.blocks[number];
    BakedBlock baked;
    for (const MaterialSet& set : asset.parts[place.part].sets) {
        BakedRows rows(rowsOf(set.transport).terms);
        rows.transport = rowsOf(set.transport);
        for (size_t row = 0; row < rowsOf(set.transport).rows(); row++)
            rows.losses.push_back({1.0 / double(row + 3), 0.1 / double(row + 3), 1e-5 / double(row + 7)});
        baked.sets.push_back(rows.vertices(place.first, place.end));
    }
    return baked;
}

// All of them, stored.
class SampleBlocks : public StoredBlocks {
  public:
    SampleBlocks(const BakePlan& plan, const Asset& asset) {
        for (uint32_t number = 0; number < plan.blocks.size(); number++) {
            mBlocks.push_back(storeBlock(plan, number, bakedBlock(plan, asset, number)));
            mEntries.emplace_back();
            for (const StoredChunk& chunk : mBlocks.back().chunks) mEntries.back().push_back(chunk.entry);
        }
    }

    const std::vector<ChunkEntry>& chunks(uint32_t block) const override { return mEntries[block]; }
    const TransportLosses& losses(uint32_t block) const override { return mBlocks[block].losses; }
    std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const override {
        for (const StoredChunk& chunk : mBlocks[block].chunks)
            if (chunk.entry.owner == entry.owner) return chunk.bytes;
        return {};
    }

  private:
    std::vector<StoredBlock> mBlocks;
    std::vector<std::vector<ChunkEntry>> mEntries;
};

using Bytes = std::vector<std::byte>;

inline ChunkWriter::Output appendTo(Bytes& bytes) {
    return [&bytes](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); };
}

inline std::vector<Bytes> shardsOf(const Asset& asset, uint32_t count,
                                   TransportLayout layout = TransportLayout::Rows) {
    const BakePlan plan = planIn(asset, layout);
    const SampleBlocks blocks(plan, asset);
    std::vector<Bytes> files(count);
    for (uint32_t index = 0; index < count; index++)
        writeShard(plan, {index, count}, blocks, appendTo(files[index]));
    return files;
}

// Of files "0", "1", …. Throws Error.
inline Bytes merged(const std::vector<Bytes>& files) {
    std::vector<ShardFile> shards;
    for (size_t i = 0; i < files.size(); i++) shards.emplace_back(sourceOf(files[i]), std::to_string(i));
    Bytes whole;
    mergeShards(shards, appendTo(whole));
    return whole;
}

} // namespace relume::test
