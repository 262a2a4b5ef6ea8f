// Finished blocks as bytes of the asset's file, wherever they are kept.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/baked_rows.h"

#include <functional>

namespace relume {

// A finished block: one chunk of transport per set of its part, in the plan's layout; then chunks of
// visibility (visb) if it is kept.
struct StoredBlock {
    TransportLosses losses;
    std::vector<StoredChunk> chunks;
};

// Checks the rows, encodes them in the plan's layout, whose scale must be known, and compresses them. May be
// called concurrently. Throws Error for rows of which no valid asset can be made.
StoredBlock storeBlock(const BakePlan& plan, uint32_t block, BakedBlock baked);

// Replaces a block's visibility bits by the chunks that are stored of it, about a hundredth of the size.
void packVisibility(const BakePlan& plan, uint32_t block, BakedBlock& baked);

// Returns the number of chunks of a block.
size_t chunksOf(const BakePlan& plan, uint32_t block);

// Returns the tag, owner and run that a block's chunk must have; sizes and checksum are unset.
ChunkEntry expectedChunk(const BakePlan& plan, uint32_t block, size_t chunk);

// Returns the most bytes that the chunk can have before compression.
uint64_t mostRawBytes(const BakePlan& plan, uint32_t block, size_t chunk);

// Returns whether `entry` can be that chunk: tag, owner, run and sizes.
bool isPlausible(const BakePlan& plan, uint32_t block, size_t chunk, const ChunkEntry& entry);

// Returns the bytes that the transport of a plausible chunk takes in memory.
uint64_t memoryBytes(const BakePlan& plan, uint32_t block, const ChunkEntry& entry);

// All or some blocks of a plan, held in memory or on disk.
class StoredBlocks {
  public:
    virtual ~StoredBlocks() = default;

    // Entries and losses of a block that is present; the entries are plausible.
    virtual const std::vector<ChunkEntry>& chunks(uint32_t block) const = 0;
    virtual const TransportLosses& losses(uint32_t block) const = 0;

    // Returns the stored bytes of one of chunks(block). Throws Error if they cannot be read or are damaged.
    virtual std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const = 0;
};

// Assembles the asset's file, holding one chunk of transport at a time. Transport in bases is loaded twice,
// since its columns are counted before anything is written. Sets the plan's measured errors from the blocks'
// losses. Returns the bytes that its transport takes in memory. Calls `poll` between blocks while counting
// and passes on what it throws. Throws Error.
uint64_t writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output,
                   const std::function<void()>& poll = {});

} // namespace relume
