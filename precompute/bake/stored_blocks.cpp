#include "precompute/bake/stored_blocks.h"

#include "engine/base/check.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_check.h"
#include "engine/transport/asset_file.h"
#include "engine/transport/basis_chunk.h"
#include "engine/transport/transport_check.h"
#include "engine/transport/transport_chunk.h"
#include "engine/transport/visibility_chunk.h"
#include "precompute/layout/basis_encoder.h"
#include "precompute/layout/light_spectrum.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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
    if (chunk >= part.sets.size()) {
        const auto size = uint32_t(plan.asset.visibilitySize);
        const uint64_t first = (chunk - part.sets.size()) * plan.visibilityRun;
        const uint64_t own = std::min<uint64_t>(plan.visibilityRun, vertices - first);
        return {smallestVisibilityChunk(own, size), largestVisibilityChunk(own, size), 1};
    }
    const MaterialSet& set = part.sets[chunk];
    const auto terms = uint64_t(set.brdf.terms), rows = vertices * terms;
    switch (layoutOf(set.transport)) {
    case TransportLayout::Bases:
        return {kBasisHeaderBytes, largestBasisChunk(terms), 1};
    case TransportLayout::Rows:
        break;
    }
    const uint64_t least = kRunHeaderBytes + rows * kRunRowBytes;
    return {least, least + rows * uint64_t(plan.asset.coefficients) * kRunEntryBytes, kRunEntryBytes};
}

// One block's transport of a set, and its error, as ClusterMatrix has it.
struct EncodedTransport {
    std::vector<std::byte> bytes;
    double error = 0;
};

EncodedTransport encodeTransport(const SparseTransport& rows, const MaterialSet& set, const BakeBlock& place,
                                 uint32_t run, float unit, double price, const Asset& asset,
                                 const std::string& where) {
    const auto coefficients = uint32_t(6 * asset.faceSize * asset.faceSize);
    if (layoutOf(set.transport) == TransportLayout::Rows)
        return {encodeRun(rows, {0, rows.vertices}, place.first), 0};
    const std::vector<float> spectrum = lightSpectrum(asset.faceSize);
    const std::vector<BasisKind>& kinds = std::get<BasisTransport>(set.transport).kinds;
    const ClusterMatrix matrix = clusterMatrix(rows, 0, rows.vertices, kinds, spectrum, unit);
    const BasisAnalysis analysis = analyse(matrix);
    const EncodedCluster encoded = encodeBases(matrix, analysis, cutFor(analysis, price), kinds, spectrum);
    checkCluster(encoded.cluster, rows.vertices, kinds.size(), coefficients, where);
    if (!std::isfinite(encoded.error)) throw Error(kTooLarge);
    return {encodeBasisCluster(encoded.cluster, run, rows.vertices), encoded.error};
}

// Entries of transport that a plausible chunk of a block stands for.
uint64_t entriesOf(const BakePlan& plan, const StoredBlocks& blocks, uint32_t block,
                   const ChunkEntry& entry) {
    const size_t set = entry.owner - plan.firstSet[plan.blocks[block].part];
    if (entry.tag == kBases) // it alone can tell
        return basisColumns(unpackChunk(entry, blocks.load(block, entry), "the bake"), "the bake");
    const RawSizes sizes = rawSizes(plan, block, set);
    return (entry.rawSize - sizes.least) / sizes.step;
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
        RELUME_CHECK(plan.scale || layoutOf(part.sets[set].transport) == TransportLayout::Rows);
        const std::string where =
            fmt::format("part \"{}\", vertices from {} on as the device baked them", part.name, place.first);
        checkTransport(transport, coefficients, uint64_t(plan.asset.coefficients), where);
        const ChunkEntry chunk = expectedChunk(plan, block, set);
        const float unit = plan.scale ? plan.scale->units[chunk.owner] : 1;
        const double price = plan.scale ? plan.scale->price : 0;
        const EncodedTransport encoded =
            encodeTransport(transport, part.sets[set], place, chunk.run, unit, price, plan.asset, where);
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
    return {kLayoutTags[size_t(layoutOf(sets[chunk].transport))], plan.firstSet[place.part] + uint32_t(chunk),
            place.first / plan.blockVertices};
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

uint64_t memoryBytes(const BakePlan& plan, uint32_t block, const ChunkEntry& entry) {
    const size_t set = entry.owner - plan.firstSet[plan.blocks[block].part];
    const auto terms = uint64_t(partOf(plan, block).sets[set].brdf.terms);
    if (entry.tag == kBases) return entry.rawSize - kBasisHeaderBytes;
    constexpr uint64_t kLengthBytes = kRunRowBytes - sizeof(float); // they are elsewhere in memory
    return entry.rawSize - kRunHeaderBytes - plan.blocks[block].count() * terms * kLengthBytes;
}

uint64_t writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output,
                   const std::function<void()>& poll) {
    struct Run {
        uint32_t block;
        ChunkEntry entry;
    };
    const size_t sets = plan.firstSet.back() + plan.asset.parts.back().sets.size();
    std::vector<std::vector<Run>> runs(sets); // over all parts
    std::vector<Run> visibility;
    std::vector<uint64_t> entries(sets, 0);
    TransportLosses losses;
    uint64_t bytes = 0;
    for (uint32_t block = 0; block < plan.blocks.size(); block++) {
        if (poll) poll();
        losses.add(blocks.losses(block));
        for (const ChunkEntry& entry : blocks.chunks(block)) {
            if (entry.tag == kVisibility) {
                visibility.push_back({block, entry});
                continue;
            }
            entries[entry.owner] += entriesOf(plan, blocks, block, entry);
            bytes += memoryBytes(plan, block, entry);
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
    return bytes;
}

} // namespace relume
