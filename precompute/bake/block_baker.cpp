#include "precompute/bake/block_baker.h"

#include "engine/base/stopwatch.h"
#include "engine/vk/result.h"
#include "precompute/bake/bake_estimate.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/bake/part_passes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

namespace relume {

namespace {

// A submission cannot be interrupted, so it is kept short enough to stop within a second.
constexpr double kSubmissionSeconds = 0.4;
constexpr uint32_t kFirstSubmission = 16; // in points, before their cost is known

// Parts with fewer vertices to bake are not probed. A probe bakes points spread over its part, in rounds that
// alternate with those of other parts; the fastest round counts.
constexpr uint64_t kProbedVertices = 2048;
constexpr uint32_t kProbePoints = 16;
constexpr int kProbeRounds = 3;

bool isProbed(const BakeEstimate::Part& part) { return part.vertices - part.doneBefore >= kProbedVertices; }

// Rows of points of a part, per set, and visibility bits if these are computed and kept.
struct BakedPoints {
    std::vector<BakedRows> rows;
    std::vector<uint32_t> visibility;
};

class BlockBaker {
  public:
    BlockBaker(const vk::Device& device, const BakePlan& plan, std::span<const uint32_t> blocks,
               std::span<const uint32_t> all, const BakeLimits& limits, BakeSink& sink,
               BakeObserver& observer, KeptVisibility* kept)
        : mDevice(device), mPlan(plan), mLimits(limits), mSink(sink), mObserver(observer), mKept(kept),
          mEstimate(estimateParts(blocks, all)) {}

    // Bakes blocks of one part.
    void bakePart(std::span<const uint32_t> blocks, BakeTimes& times);

  private:
    std::vector<BakeEstimate::Part> estimateParts(std::span<const uint32_t> blocks,
                                                  std::span<const uint32_t> all);
    void probe(std::vector<BakeEstimate::Part>& parts, uint32_t first);
    void bakeGroup(std::span<const uint32_t> blocks);
    // `given` holds the points' bits if visibility is kept already.
    BakedPoints bakePoints(std::span<const shared::BakePoint> points, std::span<const uint32_t> given = {});
    BakedPoints tryPoints(std::span<const shared::BakePoint> points, std::span<const uint32_t> given);
    std::vector<shared::BakePoint> pointsOf(const BakeBlock& block) const;
    void submit(std::span<const shared::BakePoint> points, std::span<const uint32_t> given,
                BakedPoints& baked);
    const AssetPart& part() const { return mPlan.asset.parts[mPart]; }
    void usePasses(uint32_t part);

    const vk::Device& mDevice;
    const BakePlan& mPlan;
    const BakeLimits& mLimits;
    BakeSink& mSink;
    BakeObserver& mObserver;
    KeptVisibility* mKept;
    uint32_t mPart = ~0u;
    std::unique_ptr<PartPasses> mPasses; // of mPart
    uint32_t mLargest = kFirstSubmission;
    BakeEstimate mEstimate; // last: probing uses the others
};

void BlockBaker::usePasses(uint32_t number) {
    if (mPart == number) return;
    mPasses.reset(); // never two at a time
    mPart = number;
    mPasses = std::make_unique<PartPasses>(mDevice, mPlan.asset, part(), mPlan.options, mLimits,
                                           mKept ? VisibilitySource::Given : VisibilitySource::Found);
    mLargest = kFirstSubmission;
}

std::vector<BakeEstimate::Part> BlockBaker::estimateParts(std::span<const uint32_t> blocks,
                                                          std::span<const uint32_t> all) {
    std::vector<BakeEstimate::Part> parts(mPlan.asset.parts.size());
    for (uint32_t block : all) parts[mPlan.blocks[block].part].vertices += mPlan.blocks[block].count();
    for (BakeEstimate::Part& part : parts) part.doneBefore = part.vertices;
    for (uint32_t block : blocks) parts[mPlan.blocks[block].part].doneBefore -= mPlan.blocks[block].count();
    if (mKept) { // the remaining cost is in proportion to the terms
        for (size_t number = 0; number < parts.size(); number++)
            parts[number].probedSeconds = termCount(mPlan.asset.parts[number]);
        return parts;
    }
    if (std::ranges::count_if(parts, isProbed) > 1) probe(parts, mPlan.blocks[blocks.front()].part);
    return parts;
}

// Probes the parts with the passes of the first part to be baked. The cost of visibility depends on the
// points, that of the rest on the number of terms, so these passes suffice for all parts.
void BlockBaker::probe(std::vector<BakeEstimate::Part>& parts, uint32_t first) {
    usePasses(first);
    const double ownTerms = termCount(part());
    const auto rowSeconds = [&] {
        return vk::secondsOf(mPasses->times()) - vk::secondsOf(mPasses->times(), "visibility");
    };
    bakePoints(std::vector(1, bakePoint(part().mesh, 0, mPlan.asset.visibilityOffset))); // warm-up
    for (int round = 0; round < kProbeRounds; round++)
        for (size_t number = 0; number < parts.size(); number++) {
            const AssetPart& probed = mPlan.asset.parts[number];
            if (!isProbed(parts[number])) continue;
            std::vector<shared::BakePoint> points;
            for (uint32_t i = 0; i < kProbePoints; i++)
                points.push_back(bakePoint(probed.mesh, i * probed.mesh.vertexCount() / kProbePoints,
                                           mPlan.asset.visibilityOffset));
            const double rowsBefore = rowSeconds();
            const Stopwatch watch;
            bakePoints(points);
            const double rows = rowSeconds() - rowsBefore;
            const double seconds =
                (watch.seconds() + rows * (termCount(probed) / ownTerms - 1)) / kProbePoints;
            double& best = parts[number].probedSeconds;
            best = round == 0 ? seconds : std::min(best, seconds);
        }
    // Parts without a probe are taken to cost as much as the first probed one.
    const double usual = std::ranges::find_if(parts, isProbed)->probedSeconds;
    for (BakeEstimate::Part& part : parts)
        if (!isProbed(part)) part.probedSeconds = usual;
}

void BlockBaker::submit(std::span<const shared::BakePoint> points, std::span<const uint32_t> given,
                        BakedPoints& baked) {
    if (mObserver.wantsStop()) throw BakeStopped("stopped");
    const Stopwatch watch;
    const bool isWanted = mPlan.options.keepVisibility && !mKept;
    mPasses->bake(points, baked.rows, given, isWanted ? &baked.visibility : nullptr);
    const double perPoint = watch.seconds() / double(points.size());
    mLargest = uint32_t(std::clamp(kSubmissionSeconds / perPoint, 1.0, double(mPasses->batch())));
}

BakedPoints BlockBaker::bakePoints(std::span<const shared::BakePoint> points,
                                   std::span<const uint32_t> given) {
    for (;;) {
        try {
            return tryPoints(points, given);
        } catch (const vk::OutOfMemory& failure) {
            if (!mPasses->halveBatch(failure.what())) throw;
        } catch (const std::bad_alloc&) {
            if (!mPasses->halveBatch("out of host memory")) throw;
        }
    }
}

BakedPoints BlockBaker::tryPoints(std::span<const shared::BakePoint> points,
                                  std::span<const uint32_t> given) {
    BakedPoints baked{emptyBakedRows(part()), {}};
    const size_t givenWords = given.size() / points.size();
    while (!points.empty()) {
        // Points are divided evenly among submissions.
        const size_t largest = std::min(mLargest, mPasses->batch());
        const size_t submissions = (points.size() + largest - 1) / largest;
        const size_t count = (points.size() + submissions - 1) / submissions;
        submit(points.first(count), given.first(count * givenWords), baked);
        points = points.subspan(count);
        given = given.subspan(count * givenWords);
    }
    return baked;
}

std::vector<shared::BakePoint> BlockBaker::pointsOf(const BakeBlock& block) const {
    std::vector<shared::BakePoint> points;
    for (uint32_t vertex = block.first; vertex < block.end; vertex++)
        points.push_back(bakePoint(part().mesh, vertex, mPlan.asset.visibilityOffset));
    return points;
}

void BlockBaker::bakeGroup(std::span<const uint32_t> blocks) {
    const Stopwatch watch;
    std::vector<shared::BakePoint> points;
    std::vector<uint32_t> given;
    for (uint32_t block : blocks) {
        const BakeBlock& place = mPlan.blocks[block];
        std::ranges::copy(pointsOf(place), std::back_inserter(points));
        if (mKept)
            std::ranges::copy(mKept->bits(place.part, place.first, place.end), std::back_inserter(given));
    }
    const BakedPoints all = bakePoints(points, given);
    const std::vector<uint32_t>& visibility = mKept ? given : all.visibility;
    const size_t vertexWords = visibilityBytes(uint32_t(mPlan.asset.visibilitySize)) / 4;
    uint32_t first = 0;
    for (uint32_t block : blocks) {
        const uint32_t end = first + mPlan.blocks[block].count();
        BakedBlock baked;
        for (const BakedRows& set : all.rows) baked.sets.push_back(set.vertices(first, end));
        if (mPlan.bounced) mPlan.bounced->addTo(baked.sets, mPlan.asset, mPart, mPlan.blocks[block].first);
        if (mPlan.options.keepVisibility)
            baked.visibility.assign(visibility.begin() + ptrdiff_t(first * vertexWords),
                                    visibility.begin() + ptrdiff_t(end * vertexWords));
        mSink.take(block, std::move(baked));
        first = end;
    }
    mEstimate.add(mPart, first, watch.seconds());
    mObserver.progress(mEstimate.status());
}

void BlockBaker::bakePart(std::span<const uint32_t> blocks, BakeTimes& times) {
    usePasses(mPlan.blocks[blocks.front()].part);
    mObserver.stage(BakeStage::Baking, part().name);
    times.batch = std::max(times.batch, mPasses->batch());
    while (!blocks.empty()) {
        const size_t together = std::max(1u, mLargest / mPlan.blockVertices);
        const auto group = blocks.first(std::min(together, blocks.size()));
        bakeGroup(group);
        blocks = blocks.subspan(group.size());
    }
    for (const auto& [name, seconds] : mPasses->times()) vk::addTime(times.device, name, seconds);
}

} // namespace

void bakeBlocks(const vk::Device& device, const BakePlan& plan, std::span<const uint32_t> blocks,
                std::span<const uint32_t> all, const BakeLimits& limits, BakeSink& sink,
                BakeObserver& observer, BakeTimes& times, KeptVisibility* kept) {
    if (blocks.empty()) return;
    BlockBaker baker(device, plan, blocks, all, limits, sink, observer, kept);
    try {
        while (!blocks.empty()) {
            const uint32_t part = plan.blocks[blocks.front()].part;
            const auto next =
                std::ranges::find_if(blocks, [&](uint32_t block) { return plan.blocks[block].part != part; });
            const auto own = blocks.first(size_t(next - blocks.begin()));
            baker.bakePart(own, times);
            blocks = blocks.subspan(own.size());
        }
    } catch (...) { // keep what is baked
        try {
            sink.finish();
        } catch (...) { // the first error says more
        }
        throw;
    }
    sink.finish();
}

} // namespace relume
