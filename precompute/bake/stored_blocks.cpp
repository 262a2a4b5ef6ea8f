#include "precompute/bake/stored_blocks.h"

#include "engine/base/check.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_file.h"
#include "engine/transport/transport_chunk.h"

namespace relume {

namespace {

uint64_t runBytes(const BakePlan& plan, uint32_t block, const MaterialSet& set, uint64_t entriesPerRow) {
    const uint64_t rows = uint64_t(plan.blocks[block].count()) * uint64_t(set.brdf.terms);
    return kRunHeaderBytes + rows * (kRunRowBytes + entriesPerRow * kRunEntryBytes);
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
    return stored;
}

ChunkEntry expectedChunk(const BakePlan& plan, uint32_t block, size_t set) {
    const BakeBlock& place = plan.blocks[block];
    return {kTransport, plan.firstSet[place.part] + uint32_t(set), place.first / plan.blockVertices};
}

uint64_t mostRunBytes(const BakePlan& plan, uint32_t block, const MaterialSet& set) {
    return runBytes(plan, block, set, uint64_t(plan.asset.coefficients));
}

bool isPlausible(const BakePlan& plan, uint32_t block, size_t set, const ChunkEntry& entry) {
    const ChunkEntry expected = expectedChunk(plan, block, set);
    const MaterialSet& materials = plan.asset.parts[plan.blocks[block].part].sets[set];
    const uint64_t least = runBytes(plan, block, materials, 0);
    return entry.tag == expected.tag && entry.owner == expected.owner && entry.run == expected.run &&
           entry.rawSize >= least && entry.rawSize <= mostRunBytes(plan, block, materials) &&
           (entry.rawSize - least) % kRunEntryBytes == 0 && entry.storedSize > 0 &&
           entry.storedSize <= entry.rawSize;
}

uint64_t entriesOf(const BakePlan& plan, uint32_t block, const ChunkEntry& entry) {
    const uint32_t part = plan.blocks[block].part;
    const MaterialSet& set = plan.asset.parts[part].sets[entry.owner - plan.firstSet[part]];
    return (entry.rawSize - runBytes(plan, block, set, 0)) / kRunEntryBytes;
}

void writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output) {
    struct Run {
        uint32_t block;
        ChunkEntry entry;
    };
    const size_t sets = plan.firstSet.back() + plan.asset.parts.back().sets.size();
    std::vector<std::vector<Run>> runs(sets); // over all parts
    std::vector<uint64_t> entries(sets, 0);
    TransportLosses losses;
    for (uint32_t block = 0; block < plan.blocks.size(); block++) {
        losses.add(blocks.losses(block));
        for (const ChunkEntry& entry : blocks.chunks(block)) {
            entries[entry.owner] += entriesOf(plan, block, entry);
            runs[entry.owner].push_back({block, entry});
        }
    }
    setErrors(losses, plan.asset);
    checkSkeleton(plan.asset, "the bake");

    ChunkWriter chunks;
    addChunks(chunks, plan.asset, entries, [&](uint32_t set) {
        for (const Run& run : runs[set])
            chunks.addStored(run.entry, [&blocks, run] { return blocks.load(run.block, run.entry); });
    });
    chunks.finish(output);
}

} // namespace relume
