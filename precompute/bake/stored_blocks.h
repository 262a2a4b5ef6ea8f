// Finished blocks in the bytes of the asset's file, wherever they are kept.
#pragma once

#include "engine/transport/chunk_file.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/baked_rows.h"

namespace relume {

// A finished block: a TRAN chunk per set of its part, then a visb chunk where visibility is kept.
struct StoredBlock {
    TransportLosses losses;
    std::vector<StoredChunk> chunks;
};

// Checks the rows, encodes and compresses them. Throws Error for rows that make no valid asset.
StoredBlock storeBlock(const BakePlan& plan, uint32_t block, const BakedBlock& baked);

// How many chunks a block has.
size_t chunksOf(const BakePlan& plan, uint32_t block);

// One of these as it must be, but for sizes and checksum.
ChunkEntry expectedChunk(const BakePlan& plan, uint32_t block, size_t chunk);

// Most bytes of it before compression.
uint64_t mostRawBytes(const BakePlan& plan, uint32_t block, size_t chunk);

// Whether an entry can be it.
bool isPlausible(const BakePlan& plan, uint32_t block, size_t chunk, const ChunkEntry& entry);

// Transport entries that a plausible TRAN chunk of a block stands for.
uint64_t entriesOf(const BakePlan& plan, uint32_t block, const ChunkEntry& entry);

// All blocks of a plan, or some, that are kept on disk.
class StoredBlocks {
  public:
    virtual ~StoredBlocks() = default;

    // Of a block that is there: entries that are plausible, and what it lost.
    virtual const std::vector<ChunkEntry>& chunks(uint32_t block) const = 0;
    virtual const TransportLosses& losses(uint32_t block) const = 0;

    // Stored bytes of one of chunks(block). Throws Error when they cannot be read or are damaged.
    virtual std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const = 0;
};

// Puts the asset's file together, holding one chunk of transport at a time: each block is copied to where it
// belongs. Sets the plan's measured errors from the blocks' losses. Throws Error.
void writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output);

} // namespace relume
