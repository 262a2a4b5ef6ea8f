// The file of one shard of a bake: an asset that has the rows of the shard's blocks only
// (docs/asset_format.md).
#pragma once

#include "engine/base/file.h"
#include "engine/transport/asset_meta.h"
#include "precompute/bake/shard.h"
#include "precompute/bake/stored_blocks.h"

#include <memory>

namespace relume {

// Writes a shard, all of whose blocks must be in `blocks`.
void writeShard(const BakePlan& plan, const Shard& shard, const StoredBlocks& blocks,
                const ChunkWriter::Output& output);

// A shard on disk or in memory. Holds no more than its table, its description and its losses.
class ShardFile {
  public:
    // Called with the number of bytes just read; what it throws is passed on.
    using Watch = std::function<void(uint64_t bytes)>;

    // Verifies the file as ChunkFile does, and the shard's own chunks. Throws Error for anything but a shard.
    ShardFile(const std::filesystem::path& path, const Watch& watch);
    ShardFile(ByteSource source, std::string name);

    const Shard& shard() const { return mShard; }
    const std::string& identity() const { return mIdentity; } // BakePlan::identity, as recorded
    const AssetMeta& meta() const { return mMeta; }
    const std::string& metaText() const { return mMetaText; }
    const ChunkFile& chunks() const { return mChunks; }
    const std::string& name() const { return mChunks.name(); }

    // Returns the plan from which it was baked, rebuilt from its content. Throws Error if that contradicts
    // its identity.
    BakePlan plan() const;

    // Returns the losses of its blocks, in order. Throws Error unless there are `blocks` of them.
    std::vector<TransportLosses> losses(uint32_t blocks) const;

  private:
    std::shared_ptr<FileReader> mFile; // null if in memory
    ChunkFile mChunks;
    AssetMeta mMeta;
    std::string mMetaText;
    Shard mShard;
    std::string mIdentity;
};

} // namespace relume
