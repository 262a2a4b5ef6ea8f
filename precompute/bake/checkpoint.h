// The checkpoint: finished blocks of a bake on disk, from which it resumes (docs/checkpoint_format.md).
#pragma once

#include "precompute/bake/stored_blocks.h"

#include <chrono>
#include <filesystem>
#include <optional>

namespace relume {

// An append-only file of blocks, locked by one process at a time.
class Checkpoint : public StoredBlocks {
  public:
    // Opens or creates the file and locks it. Throws Error if another process holds it, if it is not a
    // checkpoint, or if it cannot be written.
    explicit Checkpoint(std::filesystem::path path);
    // Unlocks the file, and deletes it if it is empty.
    ~Checkpoint() override;
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    // Returns whether the file was begun for this plan.
    bool matches(const BakePlan& plan) const;

    // Reads the blocks of this plan; to be called once, before the functions below. Drops what a crash left
    // half written; if the file is of another plan, drops everything and logs a warning.
    void resume(const BakePlan& plan);

    bool has(uint32_t block) const { return mBlocks[block].has_value(); }
    // Returns entries whose offsets are relative to the checkpoint file.
    const std::vector<ChunkEntry>& chunks(uint32_t block) const override { return mBlocks[block]->chunks; }
    const TransportLosses& losses(uint32_t block) const override { return mBlocks[block]->losses; }
    std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const override;

    // Returns the scale that the blocks are encoded with, if stored. Needed, and appended, only for layouts
    // other than rows, before their blocks.
    const std::optional<LayoutScale>& scale() const { return mScale; }
    void append(const LayoutScale& scale);

    // Throws Error on failure, such as a full disk, and leaves the file as it was.
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
    uint64_t mBytes = 0; // length of the valid part of the file
    std::vector<std::optional<Kept>> mBlocks;
    std::optional<LayoutScale> mScale;
    std::chrono::steady_clock::time_point mSynced;
};

} // namespace relume
