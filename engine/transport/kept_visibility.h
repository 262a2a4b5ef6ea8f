// Visibility that a bake kept in its file, read block by block.
#pragma once

#include "engine/transport/asset_file.h"

#include <filesystem>
#include <optional>

namespace relume {

class KeptVisibility {
  public:
    // Opens a .relume file, whether it keeps visibility or not, and verifies its checksums. Holds little of
    // it at a time. Throws Error for one that cannot be read.
    explicit KeptVisibility(const std::filesystem::path& path);
    // The same of bytes that `name` stands for in errors.
    KeptVisibility(ByteSource source, const std::string& name);

    // Says of what the visibility is, and how it was found (visibility_key.h); empty: none is kept.
    const std::string& key() const { return mMeta.visibilityKey; }

    // Throws Error unless there are bits of all vertices of an asset of such parts, in its size.
    void verify(const Asset& asset) const;

    // All of the bake but its rows, and checked so far. Throws Error.
    Asset skeleton() const;

    // Once verified: bits of vertices [first, end) of a part, 6 · size² each, as Visibility::record() gave
    // them. Quick for vertices that follow those of the last call. Throws Error when they are damaged.
    std::vector<uint32_t> bits(uint32_t part, uint32_t first, uint32_t end);

    uint64_t storedBytes() const; // in the file
    uint32_t size() const { return uint32_t(mMeta.asset.visibilitySize); }
    const ChunkFile& file() const { return mFile; }

  private:
    uint32_t runVertices(uint32_t part, uint32_t run) const;
    const std::vector<uint32_t>& run(uint32_t part, uint32_t run);

    ChunkFile mFile;
    AssetMeta mMeta;
    uint32_t mRun;                              // vertices
    std::vector<std::vector<ChunkEntry>> mRuns; // per part
    struct Run {
        uint32_t part, run;
        std::vector<uint32_t> bits;
    };
    std::optional<Run> mLast;
};

} // namespace relume
