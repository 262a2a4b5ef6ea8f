#include "precompute/bake/preview.h"

#include "precompute/bake/interpolated_blocks.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>

namespace relume {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Writing a preview again takes at most such a share of the time since the last.
constexpr double kWritingShare = 0.1;

// Baked blocks, and interpolated ones in place of the others.
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

// Passes blocks on, and writes a preview after every portion but the last.
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
        if (mWriteSeconds > kWritingShare * secondsSince(mWritten)) return;
        finish();
        writePreview();
    }
    void finish() override { mSink.finish(); }

    void writePreview() {
        const Clock::time_point start = Clock::now();
        uint64_t baked = 0;
        for (uint32_t block = 0; block < mPlan.blocks.size(); block++)
            if (mCheckpoint.has(block)) baked += mPlan.blocks[block].count();
        std::optional<float>& share = mPlan.asset.provenance.bakedShare;
        share = float(double(baked) / double(mPlan.vertices()));
        mWrite(MixedBlocks(mCheckpoint, mInterpolated));
        mWritten = Clock::now();
        mWriteSeconds = secondsSince(start);
        mSeconds += mWriteSeconds;
        mObserver.preview(double(*share));
        share.reset();
    }

    double seconds() const { return mSeconds; }

  private:
    BakePlan& mPlan;
    const Checkpoint &mCheckpoint, &mInterpolated;
    BakeSink& mSink;
    const PreviewWriter& mWrite;
    BakeObserver& mObserver;
    std::vector<uint32_t> mLasts; // of portions
    Clock::time_point mWritten;
    double mWriteSeconds = 0, mSeconds = 0; // the last time, in all
};

} // namespace

std::vector<std::vector<uint32_t>> previewPortions(const BakePlan& plan, std::span<const uint32_t> blocks) {
    // Every fourth block of a part, then those half-way between, then the others.
    constexpr std::array<size_t, 4> kPortions = {0, 2, 1, 3};
    std::vector<std::vector<uint32_t>> portions(kPortions.size());
    for (const uint32_t block : blocks) {
        const size_t place = plan.blocks[block].first / plan.blockVertices;
        portions[kPortions[place % kPortions.size()]].push_back(block);
    }
    std::erase_if(portions, [](const auto& portion) { return portion.empty(); });
    // To and fro, so that the passes of a part at an end serve two portions.
    for (size_t number = 1; number < portions.size(); number += 2) std::ranges::reverse(portions[number]);
    return portions;
}

void bakeWithPreviews(const vk::Device& device, BakePlan& plan, std::span<const uint32_t> missing,
                      const BakeLimits& limits, const Checkpoint& checkpoint, Checkpoint& interpolated,
                      BakeSink& sink, const PreviewWriter& write, BakeObserver& observer, BakeTimes& times,
                      KeptVisibility* kept) {
    const Clock::time_point start = Clock::now();
    observer.stage(BakeStage::Preview, "");
    interpolateBlocks(device, plan, missing, limits, interpolated, observer);
    const double interpolating = secondsSince(start);
    const std::vector<std::vector<uint32_t>> portions = previewPortions(plan, missing);
    std::vector<uint32_t> order;
    for (const std::vector<uint32_t>& portion : portions)
        order.insert(order.end(), portion.begin(), portion.end());
    PreviewSink previews(plan, checkpoint, interpolated, sink, portions, write, observer);
    previews.writePreview();
    std::vector<uint32_t> all(plan.blocks.size());
    std::iota(all.begin(), all.end(), 0u);
    bakeBlocks(device, plan, order, all, limits, previews, observer, times, kept);
    times.previews = interpolating + previews.seconds();
}

} // namespace relume
