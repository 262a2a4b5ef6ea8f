// A checkpoint of a small bake, and what a bake makes of one.
#pragma once

#include "precompute/bake/checkpoint.h"
#include "tests/support/shard_sample.h"
#include "tests/support/temporary_folder.h"

#include <fstream>

namespace relume::test {

inline StoredBlock blockOf(const StoredBlocks& blocks, uint32_t block) {
    StoredBlock stored{blocks.losses(block), {}};
    for (const ChunkEntry& entry : blocks.chunks(block))
        stored.chunks.push_back({entry, blocks.load(block, entry)});
    return stored;
}

// Makes every record's checksum right that the sizes before it still let one find.
inline void resealCheckpoint(Bytes& bytes) {
    constexpr size_t kHeaderBytes = 52, kRecordHeaderBytes = 24;
    for (size_t start = kHeaderBytes; start + kRecordHeaderBytes <= bytes.size();) {
        const std::span<std::byte> record = std::span(bytes).subspan(start);
        const auto size = ByteReader(record.subspan(8), "").get<uint64_t>();
        if (size > record.size() - kRecordHeaderBytes) return;
        Bytes sealed(record.begin(), record.begin() + 16);
        const auto body = record.subspan(kRecordHeaderBytes, size);
        sealed.insert(sealed.end(), body.begin(), body.end());
        poke(record, 16, hash64(sealed), 8);
        start += kRecordHeaderBytes + size;
    }
}

class CheckpointSample {
  public:
    explicit CheckpointSample(TransportLayout layout, Asset asset = shardedAsset())
        : mAsset(std::move(asset)), mPlan(planIn(mAsset, layout)), mBlocks(mPlan, mAsset) {
        {
            Checkpoint checkpoint(path());
            checkpoint.resume(mPlan);
            fill(checkpoint);
        }
        mFile = readFile(path());
        BakePlan plan = mPlan;
        writeBake(plan, mBlocks, appendTo(mBake));
    }

    const Bytes& file() const { return mFile; }
    const Bytes& bake() const { return mBake; }

    // The bake that goes on from this checkpoint: what is missing is baked again. Throws Error. `found`, if
    // there is one, becomes the number of blocks that were there.
    Bytes resumed(const Bytes& file, size_t* found = nullptr) const {
        std::filesystem::remove(path()); // overwritten, it might be flushed to the disk
        std::ofstream(path(), std::ios::binary)
            .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
        Checkpoint checkpoint(path());
        checkpoint.resume(mPlan);
        size_t known = 0;
        for (uint32_t block = 0; block < mPlan.blocks.size(); block++) known += checkpoint.has(block);
        if (found) *found = known;
        BakePlan plan = mPlan;
        if (checkpoint.scale()) plan.scale = checkpoint.scale();
        fill(checkpoint);
        Bytes bake;
        writeBake(plan, checkpoint, appendTo(bake));
        return bake;
    }

  private:
    std::filesystem::path path() const { return mFolder.path() / "checkpoint"; }

    void fill(Checkpoint& checkpoint) const {
        if (mPlan.scale && !checkpoint.scale()) checkpoint.append(*mPlan.scale);
        for (uint32_t block = 0; block < mPlan.blocks.size(); block++)
            if (!checkpoint.has(block)) checkpoint.append(block, blockOf(mBlocks, block));
    }

    TemporaryFolder mFolder;
    Asset mAsset;
    BakePlan mPlan;
    SampleBlocks mBlocks;
    Bytes mFile, mBake;
};

} // namespace relume::test
