// What one machine of several baked: a file with all of the asset but the rows of the others' blocks.
// docs/asset_format.md.
#pragma once

#include "engine/base/file.h"
#include "engine/transport/asset_meta.h"
#include "precompute/bake/shard.h"
#include "precompute/bake/stored_blocks.h"

#include <memory>

namespace relume {

// Writes a shard, whose blocks are all there.
void writeShard(const BakePlan& plan, const Shard& shard, const StoredBlocks& blocks,
                const ChunkWriter::Output& output);

// A shard on disk, or in memory, of which no more than its table, its description and what it lost is held.
class ShardFile {
  public:
    // Is told how many bytes have just been read. What it throws comes through.
    using Watch = std::function<void(uint64_t bytes)>;

    // Verifies what ChunkFile does, and the shard's own chunks. Throws Error for anything else than a shard.
    ShardFile(const std::filesystem::path& path, const Watch& watch);
    ShardFile(ByteSource source, std::string name);

    const Shard& shard() const { return mShard; }
    const std::string& identity() const { return mIdentity; } // as it says: BakePlan::identity
    const AssetMeta& meta() const { return mMeta; }
    const std::string& metaText() const { return mMetaText; }
    const ChunkFile& chunks() const { return mChunks; }
    const std::string& name() const { return mChunks.name(); }

    // The plan that it was baked by, found anew from its content. Throws Error where that is not what its
    // identity says.
    BakePlan plan() const;

    // What its blocks lost, in their order. Throws Error unless they are so many.
    std::vector<TransportLosses> losses(uint32_t blocks) const;

  private:
    std::shared_ptr<FileReader> mFile; // where it is on disk
    ChunkFile mChunks;
    AssetMeta mMeta;
    std::string mMetaText;
    Shard mShard;
    std::string mIdentity;
};

} // namespace relume
