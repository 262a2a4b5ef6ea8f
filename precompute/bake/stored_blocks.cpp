#include "precompute/bake/stored_blocks.h"

#include "engine/base/check.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_file.h"
#include "engine/transport/transport_check.h"
#include "engine/transport/transport_chunk.h"
#include "engine/transport/visibility_chunk.h"

namespace relume {

namespace {

const AssetPart& partOf(const BakePlan& plan, uint32_t block) {
    return plan.asset.parts[plan.blocks[block].part];
}

// Of a chunk before compression.
struct RawSizes {
    uint64_t least, most, step;
};

RawSizes rawSizes(const BakePlan& plan, uint32_t block, size_t chunk) {
    const uint64_t vertices = plan.blocks[block].count();
    const AssetPart& part = partOf(plan, block);
    if (chunk == part.sets.size()) {
        const auto size = uint32_t(plan.asset.visibilitySize);
        return {smallestVisibilityChunk(vertices, size), largestVisibilityChunk(vertices, size), 1};
    }
    const uint64_t rows = vertices * uint64_t(part.sets[chunk].brdf.terms);
    const uint64_t least = kRunHeaderBytes + rows * kRunRowBytes;
    return {least, least + rows * uint64_t(plan.asset.coefficients) * kRunEntryBytes, kRunEntryBytes};
}

} // namespace

StoredBlock storeBlock(const BakePlan& plan, uint32_t block, const BakedBlock& baked) {
    const BakeBlock& place = plan.blocks[block];
    const auto coefficients = uint32_t(6 * plan.asset.faceSize * plan.asset.faceSize);
    StoredBlock stored{baked.losses(), {}};
    for (size_t set = 0; set < baked.sets.size(); set++) {
        const SparseTransport& transport = baked.sets[set].transport;
        RELUME_CHECK_EQ(transport.vertices, place.count());
        checkTransport(transport, coefficients, uint64_t(plan.asset.coefficients),
                       fmt::format("part \"{}\", vertices from {} on as the device baked them",
                                   plan.asset.parts[place.part].name, place.first));
        const ChunkEntry chunk = expectedChunk(plan, block, set);
        stored.chunks.push_back(storeChunk(chunk.tag, chunk.owner, chunk.run,
                                           encodeRun(transport, {0, transport.vertices}, place.first)));
    }
    if (plan.options.keepVisibility) {
        const ChunkEntry chunk = expectedChunk(plan, block, baked.sets.size());
        stored.chunks.push_back(
            storeChunk(chunk.tag, chunk.owner, chunk.run,
                       encodeVisibility(baked.visibility, uint32_t(plan.asset.visibilitySize))));
    }
    return stored;
}

size_t chunksOf(const BakePlan& plan, uint32_t block) {
    return partOf(plan, block).sets.size() + plan.options.keepVisibility;
}

ChunkEntry expectedChunk(const BakePlan& plan, uint32_t block, size_t chunk) {
    const BakeBlock& place = plan.blocks[block];
    const uint32_t run = place.first / plan.blockVertices;
    if (chunk == partOf(plan, block).sets.size()) return {kVisibility, place.part, run};
    return {kTransport, plan.firstSet[place.part] + uint32_t(chunk), run};
}

uint64_t mostRawBytes(const BakePlan& plan, uint32_t block, size_t chunk) {
    return rawSizes(plan, block, chunk).most;
}

bool isPlausible(const BakePlan& plan, uint32_t block, size_t chunk, const ChunkEntry& entry) {
    const ChunkEntry expected = expectedChunk(plan, block, chunk);
    const RawSizes sizes = rawSizes(plan, block, chunk);
    return entry.tag == expected.tag && entry.owner == expected.owner && entry.run == expected.run &&
           entry.rawSize >= sizes.least && entry.rawSize <= sizes.most &&
           (entry.rawSize - sizes.least) % sizes.step == 0 && entry.storedSize > 0 &&
           entry.storedSize <= entry.rawSize;
}

uint64_t entriesOf(const BakePlan& plan, uint32_t block, const ChunkEntry& entry) {
    const size_t set = entry.owner - plan.firstSet[plan.blocks[block].part];
    return (entry.rawSize - rawSizes(plan, block, set).least) / kRunEntryBytes;
}

void writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output) {
    struct Run {
        uint32_t block;
        ChunkEntry entry;
    };
    const size_t sets = plan.firstSet.back() + plan.asset.parts.back().sets.size();
    std::vector<std::vector<Run>> runs(sets); // over all parts
    std::vector<Run> visibility;
    std::vector<uint64_t> entries(sets, 0);
    TransportLosses losses;
    for (uint32_t block = 0; block < plan.blocks.size(); block++) {
        losses.add(blocks.losses(block));
        for (const ChunkEntry& entry : blocks.chunks(block)) {
            if (entry.tag == kVisibility) {
                visibility.push_back({block, entry});
                continue;
            }
            entries[entry.owner] += entriesOf(plan, block, entry);
            runs[entry.owner].push_back({block, entry});
        }
    }
    setErrors(losses, plan.asset);
    checkSkeleton(plan.asset, "the bake");

    ChunkWriter chunks;
    const auto addStored = [&](const std::vector<Run>& stored) {
        for (const Run& run : stored)
            chunks.addStored(run.entry, [&blocks, run] { return blocks.load(run.block, run.entry); });
    };
    addChunks(
        chunks, plan.asset, entries, [&](uint32_t set) { addStored(runs[set]); },
        plan.options.keepVisibility ? plan.visibilityKey : "");
    addStored(visibility);
    chunks.finish(output);
}

} // namespace relume
