// Finished blocks as bytes of the asset's file, wherever they are kept.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/baked_rows.h"

#include <functional>
#include <map>

namespace relume {

constexpr size_t kBytesPerLoss = 4 * sizeof(double); // of TransportLosses, in files

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

// Adds all chunks of the plan's asset, of whose transport and visibility the file gets the blocks `numbers`,
// in this order. `setEntries` is as for addChunks() (asset_file.h). `blocks` must outlive the writer's
// finish().
void addBlocks(ChunkWriter& file, const BakePlan& plan, const StoredBlocks& blocks,
               std::span<const uint32_t> numbers, std::span<const uint64_t> setEntries);

// Assembles the asset's file, holding one chunk of transport at a time. Transport in bases is loaded twice,
// since its columns are counted before anything is written. Sets the plan's measured errors from the blocks'
// losses. Returns the bytes that its transport takes in memory. Calls `poll` between blocks while counting
// and passes on what it throws. Throws Error.
uint64_t writeBake(BakePlan& plan, const StoredBlocks& blocks, const ChunkWriter::Output& output,
                   const std::function<void()>& poll = {});

// Finished blocks held in memory.
class MemoryBlocks : public StoredBlocks {
  public:
    void keep(uint32_t block, StoredBlock stored) {
        std::vector<ChunkEntry>& entries = mEntries[block];
        for (size_t i = 0; i < stored.chunks.size(); i++) {
            entries.push_back(stored.chunks[i].entry);
            entries.back().offset = i; // index of the chunk, in place of a file offset
        }
        mBlocks[block] = std::move(stored);
    }

    const std::vector<ChunkEntry>& chunks(uint32_t block) const override { return mEntries.at(block); }
    const TransportLosses& losses(uint32_t block) const override { return mBlocks.at(block).losses; }
    std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const override {
        return mBlocks.at(block).chunks[entry.offset].bytes;
    }

  private:
    std::map<uint32_t, StoredBlock> mBlocks;
    std::map<uint32_t, std::vector<ChunkEntry>> mEntries;
};

} // namespace relume
