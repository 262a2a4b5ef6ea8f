#include "precompute/bake/preview.h"

#include "engine/base/stopwatch.h"
#include "precompute/bake/baked_options.h"
#include "precompute/bake/stored_blocks.h"

#include <algorithm>
#include <array>
#include <utility>

namespace relume {

namespace {

// Writing previews takes at most this share of the time since the last one.
constexpr double kWritingShare = 0.1;

constexpr uint64_t kMostDraftBytes = uint64_t(512) << 20;

// Writes a preview that records the share of its vertices that is baked.
void writeShare(BakePlan& plan, float share, const StoredBlocks& blocks, const PreviewWriter& write) {
    plan.asset.provenance.bakedShare = share;
    write(blocks);
    plan.asset.provenance.bakedShare.reset();
}

// The baked blocks, with interpolated ones in place of those missing.
class MixedBlocks : public StoredBlocks {
  public:
    MixedBlocks(const Checkpoint& baked, const Checkpoint& interpolated)
        : mBaked(baked), mInterpolated(interpolated) {}

    const std::vector<ChunkEntry>& chunks(uint32_t block) const override { return of(block).chunks(block); }
    const TransportLosses& losses(uint32_t block) const override { return of(block).losses(block); }
    std::vector<std::byte> load(uint32_t block, const ChunkEntry& entry) const override {
        return of(block).load(block, entry);
    }

  private:
    const Checkpoint& of(uint32_t block) const { return mBaked.has(block) ? mBaked : mInterpolated; }

    const Checkpoint &mBaked, &mInterpolated;
};

// Passes blocks on and writes a preview after every portion but the last.
class PreviewSink : public BakeSink {
  public:
    PreviewSink(BakePlan& plan, const Checkpoint& checkpoint, const Checkpoint& interpolated, BakeSink& sink,
                const std::vector<std::vector<uint32_t>>& portions, const PreviewWriter& write,
                BakeObserver& observer)
        : mPlan(plan), mCheckpoint(checkpoint), mInterpolated(interpolated), mSink(sink), mWrite(write),
          mObserver(observer) {
        for (size_t i = 0; i + 1 < portions.size(); i++) mLasts.push_back(portions[i].back());
    }

    void take(uint32_t block, BakedBlock baked) override {
        mSink.take(block, std::move(baked));
        if (std::ranges::find(mLasts, block) == mLasts.end()) return;
        if (mWriteSeconds > kWritingShare * mSinceWriting.seconds()) return;
        finish();
        writePreview();
    }
    void finish() override { mSink.finish(); }

    void writePreview() {
        const Stopwatch watch;
        uint64_t baked = 0;
        for (uint32_t block = 0; block < mPlan.blocks.size(); block++)
            if (mCheckpoint.has(block)) baked += mPlan.blocks[block].count();
        const auto share = float(double(baked) / double(mPlan.vertices()));
        writeShare(mPlan, share, MixedBlocks(mCheckpoint, mInterpolated), mWrite);
        mSinceWriting.restart();
        mWriteSeconds = watch.seconds();
        mSeconds += mWriteSeconds;
        mObserver.preview(double(share));
    }

    double seconds() const { return mSeconds; }

  private:
    BakePlan& mPlan;
    const Checkpoint &mCheckpoint, &mInterpolated;
    BakeSink& mSink;
    const PreviewWriter& mWrite;
    BakeObserver& mObserver;
    std::vector<uint32_t> mLasts;           // last block of each portion
    Stopwatch mSinceWriting;                // of the last preview
    double mWriteSeconds = 0, mSeconds = 0; // for the last preview, for all
};

} // namespace

std::vector<std::vector<uint32_t>> previewPortions(const BakePlan& plan, std::span<const uint32_t> blocks) {
    // Every fourth block of a part, then those half-way between, then the rest.
    constexpr std::array<size_t, 4> kPortions = {0, 2, 1, 3};
    std::vector<std::vector<uint32_t>> portions(kPortions.size());
    for (const uint32_t block : blocks) {
        const size_t place = plan.blocks[block].first / plan.blockVertices;
        portions[kPortions[place % kPortions.size()]].push_back(block);
    }
    std::erase_if(portions, [](const auto& portion) { return portion.empty(); });
    // Alternating directions let the passes of the last part of a portion serve the next one, too.
    for (size_t number = 1; number < portions.size(); number += 2) std::ranges::reverse(portions[number]);
    return portions;
}

Previews::Previews(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> missing,
                   const BakeLimits& limits, const Checkpoint& checkpoint, Checkpoint& interpolated,
                   PreviewWriter write, BakeObserver& observer)
    : mDevice(device), mPlan(plan), mCheckpoint(checkpoint), mInterpolated(interpolated),
      mWrite(std::move(write)), mObserver(observer) {
    const Stopwatch watch;
    observer.stage(BakeStage::Preview, "");
    mInterpolated.resume(plan);
    if (std::ranges::all_of(missing, [&](uint32_t block) { return mInterpolated.has(block); })) return;
    mCoarse.emplace(device, plan, missing, limits, observer);
    mSeconds = watch.seconds();
}

void Previews::writeDraft() {
    const std::vector<uint32_t> all = mPlan.allBlocks();
    const auto isBaked = [&](uint32_t block) { return mCheckpoint.has(block); };
    if (!mCoarse || std::ranges::any_of(all, isBaked) ||
        CoarseRows::interpolatedBytes(mPlan) > kMostDraftBytes)
        return;
    const Stopwatch watch;
    const LayoutOptions layout =
        std::exchange(mPlan.options.layout, LayoutOptions{.layout = TransportLayout::Rows});
    const int bounces = std::exchange(mPlan.asset.bounces, 0);
    mPlan.options.bounces = 0;
    const std::string described =
        std::exchange(mPlan.asset.provenance.options, describeOptions(mPlan.options));
    prepareTransport(mPlan);
    MemoryBlocks blocks;
    mCoarse->interpolate(
        mPlan, all, [&](uint32_t block, StoredBlock stored) { blocks.keep(block, std::move(stored)); },
        mObserver);
    writeShare(mPlan, 0, blocks, mWrite);
    mObserver.preview(0);
    mPlan.options.layout = layout;
    mPlan.asset.bounces = mPlan.options.bounces = bounces;
    mPlan.asset.provenance.options = described;
    prepareTransport(mPlan);
    mSeconds += watch.seconds();
}

void Previews::bake(std::span<const uint32_t> missing, const BakeLimits& limits, BakeSink& sink,
                    KeptVisibility* kept, BakeTimes& times) {
    const Stopwatch watch;
    mObserver.stage(BakeStage::Preview, "");
    if (mPlan.scale && !mInterpolated.scale()) mInterpolated.append(*mPlan.scale);
    std::vector<uint32_t> lacking;
    std::ranges::copy_if(missing, std::back_inserter(lacking),
                         [&](uint32_t block) { return !mInterpolated.has(block); });
    if (mCoarse)
        mCoarse->interpolate(
            mPlan, lacking,
            [&](uint32_t block, const StoredBlock& stored) { mInterpolated.append(block, stored); },
            mObserver);
    mCoarse.reset();
    mSeconds += watch.seconds();
    const std::vector<std::vector<uint32_t>> portions = previewPortions(mPlan, missing);
    std::vector<uint32_t> order;
    for (const std::vector<uint32_t>& portion : portions)
        order.insert(order.end(), portion.begin(), portion.end());
    PreviewSink previews(mPlan, mCheckpoint, mInterpolated, sink, portions, mWrite, mObserver);
    previews.writePreview();
    bakeBlocks(mDevice, mPlan, order, mPlan.allBlocks(), limits, previews, mObserver, times, kept);
    times.previews = mSeconds + previews.seconds();
}

} // namespace relume
