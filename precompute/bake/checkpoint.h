// Finished blocks of a bake on disk, so that nothing stops it for good: docs/checkpoint_format.md.
#pragma once

#include "precompute/bake/stored_blocks.h"

#include <chrono>
#include <filesystem>
#include <optional>

namespace relume {

// An append-only file of blocks. One process at a time has it.
class Checkpoint : public StoredBlocks {
  public:
    // Makes or opens the file and locks it. Throws Error when another process has it, when it is no
    // checkpoint, or cannot be written.
    explicit Checkpoint(std::filesystem::path path);
    // Removes a file that holds nothing.
    ~Checkpoint() override;
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    // Whether it is of this very plan.
    bool matches(const BakePlan& plan) const;

    // Finds the blocks of this very plan, once, before what follows; drops what a crash left half written,
    // and everything, saying so, where the plan is another.
    void resume(const BakePlan& plan);

    bool has(uint32_t block) const { return mBlocks[block].has_value(); }
    // Entries have offsets into the checkpoint.
    const std::vector<ChunkEntry>& chunks(uint32_t block) const override { return mBlocks[block]->chunks; }
    const TransportLosses& losses(uint32_t block) const override { return mBlocks[block]->losses; }
    std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const override;

    // What the blocks that are not in rows are encoded with, once it is kept: before them.
    const std::optional<LayoutScale>& scale() const { return mScale; }
    void append(const LayoutScale& scale);

    // On failure, a full disk say, throws Error and leaves the file as it was before.
    void append(uint32_t block, const StoredBlock& stored);

    // Deletes the file.
    void remove();

    const std::filesystem::path& path() const { return mPath; }

  private:
    struct Kept {
        TransportLosses losses;
        std::vector<ChunkEntry> chunks;
    };
    void lock();
    bool readRecord(const BakePlan& plan);
    bool readScale(const BakePlan& plan, std::span<const std::byte> body);
    void writeRecord(uint32_t block, uint32_t count, std::span<const std::byte> body);
    void write(std::span<const std::byte> bytes);
    bool read(uint64_t offset, std::span<std::byte> bytes) const;

    std::filesystem::path mPath;
    int mFile = -1;
    uint64_t mBytes = 0; // of the valid file
    std::vector<std::optional<Kept>> mBlocks;
    std::optional<LayoutScale> mScale;
    std::chrono::steady_clock::time_point mSynced;
};

} // namespace relume
