// Finished blocks in the bytes of the asset's file, wherever they are kept.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/baked_rows.h"

#include <functional>

namespace relume {

// A finished block: a chunk of transport per set of its part, in its layout, then visb chunks where
// visibility is kept.
struct StoredBlock {
    TransportLosses losses;
    std::vector<StoredChunk> chunks;
};

// Checks the rows, encodes them in the plan's layout, for which its scale is known, and compresses them.
// Blocks may be stored at the same time. Throws Error for rows that make no valid asset.
StoredBlock storeBlock(const BakePlan& plan, uint32_t block, BakedBlock baked);

// Makes of a block's visibility the chunks that it will be stored as, some hundredth of its bits.
void packVisibility(const BakePlan& plan, uint32_t block, BakedBlock& baked);

// How many chunks a block has.
size_t chunksOf(const BakePlan& plan, uint32_t block);

// One of these as it must be, but for sizes and checksum.
ChunkEntry expectedChunk(const BakePlan& plan, uint32_t block, size_t chunk);

// Most bytes of it before compression.
uint64_t mostRawBytes(const BakePlan& plan, uint32_t block, size_t chunk);

// Whether an entry can be it.
bool isPlausible(const BakePlan& plan, uint32_t block, size_t chunk, const ChunkEntry& entry);

// Bytes that transport takes in memory, of a plausible chunk of it.
uint64_t memoryBytes(const BakePlan& plan, uint32_t block, const ChunkEntry& entry);

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
// belongs. Transport in bases is loaded twice: its columns are counted before anything is written. Sets the
// plan's measured errors from the blocks' losses. Returns the bytes that its transport takes in memory. Calls
// `poll` between blocks of the counting; what it throws comes through. Throws Error.
uint64_t writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output,
                   const std::function<void()>& poll = {});

} // namespace relume
