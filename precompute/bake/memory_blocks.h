// Finished blocks held in memory.
#pragma once

#include "precompute/bake/stored_blocks.h"

#include <map>

namespace relume {

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
