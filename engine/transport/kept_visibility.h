// Visibility that a bake kept in its file, read block by block.
#pragma once

#include "engine/transport/asset_file.h"

#include <filesystem>
#include <optional>

namespace relume {

// Reads the visibility kept in a .relume file.
class KeptVisibility {
  public:
    // Opens a .relume file, whether it keeps visibility or not, and verifies its checksums. Holds little of
    // it in memory at a time. Throws Error if it cannot be read.
    explicit KeptVisibility(const std::filesystem::path& path);
    // Opens bytes instead; `name` names them in errors.
    KeptVisibility(ByteSource source, const std::string& name);

    // Returns a hash of what determines visibility (precompute/bake/content_hash.h); empty if none is kept.
    const std::string& key() const { return mMeta.visibilityKey; }

    // Throws Error unless there are bits for all vertices of an asset with such parts and visibility size.
    void verify(const Asset& asset) const;

    // Returns the bake without its transport, checked. Throws Error.
    Asset skeleton() const;

    // Returns the bits of vertices [first, end) of a part, 6 · size² each, in the order of
    // Visibility::record(). Call verify() first. Fast for vertices that follow those of the last call. Throws
    // Error if they are damaged.
    std::vector<uint32_t> bits(uint32_t part, uint32_t first, uint32_t end);

    uint64_t storedBytes() const; // in the file, compressed
    // Returns the side of a face of the visibility cube, in texels.
    uint32_t size() const { return uint32_t(mMeta.asset.visibilitySize); }
    const ChunkFile& file() const { return mFile; }

  private:
    uint32_t runVertices(uint32_t part, uint32_t run) const;
    const std::vector<uint32_t>& run(uint32_t part, uint32_t run);

    ChunkFile mFile;
    AssetMeta mMeta;
    uint32_t mRun;                              // vertices per run
    std::vector<std::vector<ChunkEntry>> mRuns; // per part
    struct Run {
        uint32_t part, run;
        std::vector<uint32_t> bits;
    };
    std::optional<Run> mLast;
};

} // namespace relume
