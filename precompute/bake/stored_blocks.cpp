#include "precompute/bake/stored_blocks.h"

#include "engine/base/check.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_file.h"
#include "engine/transport/layout_chunks.h"
#include "engine/transport/visibility_chunk.h"
#include "precompute/layout/layouts.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

const AssetPart& partOf(const BakePlan& plan, uint32_t block) {
    return plan.asset.parts[plan.blocks[block].part];
}

ChunkSizes rawSizes(const BakePlan& plan, uint32_t block, size_t chunk) {
    const uint64_t vertices = plan.blocks[block].count();
    const AssetPart& part = partOf(plan, block);
    if (chunk >= part.sets.size()) {
        const auto size = uint32_t(plan.asset.visibilitySize);
        const uint64_t first = (chunk - part.sets.size()) * plan.visibilityRun;
        const uint64_t own = std::min<uint64_t>(plan.visibilityRun, vertices - first);
        return {smallestVisibilityChunk(own, size), largestVisibilityChunk(own, size), 1};
    }
    return std::visit(
        [&](const auto& layout) { return chunkSizes(layout, uint32_t(vertices), plan.asset.coefficients); },
        part.sets[chunk].transport);
}

// Returns the empty transport of the set to which a chunk belongs.
const Transport& transportOf(const BakePlan& plan, uint32_t block, const ChunkEntry& entry) {
    return partOf(plan, block).sets[entry.owner - plan.firstSet[plan.blocks[block].part]].transport;
}

// Returns the number of row entries or columns that a plausible chunk of a block holds.
uint64_t entriesOf(const BakePlan& plan, const StoredBlocks& blocks, uint32_t block,
                   const ChunkEntry& entry) {
    const auto load = [&] { return unpackChunk(entry, blocks.load(block, entry), "the bake"); };
    return std::visit(
        [&](const auto& layout) {
            return entriesOf(layout, plan.blocks[block].count(), entry.rawSize, load);
        },
        transportOf(plan, block, entry));
}

} // namespace

StoredBlock storeBlock(const BakePlan& plan, uint32_t block, BakedBlock baked) {
    const BakeBlock& place = plan.blocks[block];
    const AssetPart& part = partOf(plan, block);
    const auto coefficients = uint32_t(6 * plan.asset.faceSize * plan.asset.faceSize);
    StoredBlock stored{baked.losses(), {}};
    for (size_t set = 0; set < baked.sets.size(); set++) {
        const SparseTransport& transport = baked.sets[set].transport;
        RELUME_CHECK_EQ(transport.vertices, place.count());
        RELUME_CHECK(plan.scale || !isCompressed(layoutOf(part.sets[set].transport)));
        const std::string where =
            fmt::format("part \"{}\", vertices from {} on as the device baked them", part.name, place.first);
        checkTransport(transport, coefficients, uint64_t(rowEntries(plan.asset, part.sets[set])), where);
        const ChunkEntry chunk = expectedChunk(plan, block, set);
        const BlockCoding coding{place.first,
                                 chunk.run,
                                 plan.asset.faceSize,
                                 plan.scale ? plan.scale->norms[chunk.owner] : 1,
                                 plan.scale ? plan.scale->lambda : 0,
                                 where};
        const EncodedBlock encoded =
            std::visit([&](const auto& layout) { return encodeBlock(layout, transport, coding); },
                       part.sets[set].transport);
        if (!std::isfinite(encoded.error)) throw Error(kTooLarge);
        stored.losses.layout += encoded.error;
        stored.chunks.push_back(storeChunk(chunk.tag, chunk.owner, chunk.run, encoded.bytes));
    }
    packVisibility(plan, block, baked);
    std::ranges::move(baked.packedVisibility, std::back_inserter(stored.chunks));
    return stored;
}

void packVisibility(const BakePlan& plan, uint32_t block, BakedBlock& baked) {
    const auto size = uint32_t(plan.asset.visibilitySize);
    const size_t runWords = plan.visibilityRun * (6 * size_t(size) * size / 32);
    std::span<const uint32_t> bits = baked.visibility;
    for (size_t number = partOf(plan, block).sets.size(); !bits.empty(); number++) {
        const auto own = bits.first(std::min(runWords, bits.size()));
        const ChunkEntry chunk = expectedChunk(plan, block, number);
        baked.packedVisibility.push_back(
            storeChunk(chunk.tag, chunk.owner, chunk.run, encodeVisibility(own, size)));
        bits = bits.subspan(own.size());
    }
    baked.visibility = {};
}

size_t chunksOf(const BakePlan& plan, uint32_t block) {
    const uint32_t runs = (plan.blocks[block].count() + plan.visibilityRun - 1) / plan.visibilityRun;
    return partOf(plan, block).sets.size() + (plan.options.keepVisibility ? runs : 0);
}

ChunkEntry expectedChunk(const BakePlan& plan, uint32_t block, size_t chunk) {
    const BakeBlock& place = plan.blocks[block];
    const std::vector<MaterialSet>& sets = partOf(plan, block).sets;
    if (chunk >= sets.size())
        return {kVisibility, place.part, place.first / plan.visibilityRun + uint32_t(chunk - sets.size())};
    return {layoutTag(layoutOf(sets[chunk].transport)), plan.firstSet[place.part] + uint32_t(chunk),
            place.first / plan.blockVertices};
}

uint64_t mostRawBytes(const BakePlan& plan, uint32_t block, size_t chunk) {
    return rawSizes(plan, block, chunk).most;
}

bool isPlausible(const BakePlan& plan, uint32_t block, size_t chunk, const ChunkEntry& entry) {
    const ChunkEntry expected = expectedChunk(plan, block, chunk);
    const ChunkSizes sizes = rawSizes(plan, block, chunk);
    return entry.tag == expected.tag && entry.owner == expected.owner && entry.run == expected.run &&
           entry.rawSize >= sizes.least && entry.rawSize <= sizes.most &&
           (entry.rawSize - sizes.least) % sizes.step == 0 && entry.storedSize > 0 &&
           entry.storedSize <= entry.rawSize;
}

uint64_t memoryBytes(const BakePlan& plan, uint32_t block, const ChunkEntry& entry) {
    return std::visit(
        [&](const auto& layout) { return memoryBytes(layout, plan.blocks[block].count(), entry.rawSize); },
        transportOf(plan, block, entry));
}

void addBlocks(ChunkWriter& file, const BakePlan& plan, const StoredBlocks& blocks,
               std::span<const uint32_t> numbers, std::span<const uint64_t> setEntries) {
    struct Run {
        uint32_t block;
        ChunkEntry entry;
    };
    std::vector<std::vector<Run>> runs(plan.setCount());
    std::vector<Run> visibility;
    for (const uint32_t block : numbers)
        for (const ChunkEntry& entry : blocks.chunks(block))
            (entry.tag == kVisibility ? visibility : runs[entry.owner]).push_back({block, entry});
    const auto addStored = [&](const std::vector<Run>& stored) {
        for (const Run& run : stored)
            file.addStored(run.entry, [&blocks, run] { return blocks.load(run.block, run.entry); });
    };
    addChunks(
        file, plan.asset, setEntries, [&](uint32_t set) { addStored(runs[set]); },
        plan.options.keepVisibility ? plan.visibilityKey : "");
    addStored(visibility);
}

uint64_t writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output,
                   const std::function<void()>& poll) {
    const std::vector<uint32_t> all = plan.allBlocks();
    std::vector<uint64_t> entries(plan.setCount(), 0);
    TransportLosses losses;
    uint64_t bytes = 0;
    for (const uint32_t block : all) {
        if (poll) poll();
        losses.add(blocks.losses(block));
        for (const ChunkEntry& entry : blocks.chunks(block)) {
            if (entry.tag == kVisibility) continue;
            entries[entry.owner] += entriesOf(plan, blocks, block, entry);
            bytes += memoryBytes(plan, block, entry);
        }
    }
    setErrors(losses, plan.asset);
    checkSkeleton(plan.asset, "the bake");

    ChunkWriter chunks;
    addBlocks(chunks, plan, blocks, all, entries);
    chunks.finish(output);
    return bytes;
}

} // namespace relume
