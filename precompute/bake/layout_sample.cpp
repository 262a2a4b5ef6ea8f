#include "precompute/bake/layout_sample.h"

#include "precompute/bake/bounced_transport.h"
#include "precompute/bake/stored_blocks.h"
#include "precompute/bake/vertex_rows.h"
#include "precompute/transport/layout_work.h"
#include "precompute/transport/light_spectrum.h"
#include "precompute/transport/norm_sum.h"

#include <algorithm>

namespace relume {

namespace {

// Size of the sample: a number or a share of the vertices of all parts; a least number per part, while there
// are few parts; and limits on vertices and on bytes of rows, which are held in memory (docs/layouts.md).
constexpr uint64_t kSampleVertices = 8192, kSampleShare = 4, kLeastOfPart = 1024;
constexpr uint64_t kMostSampled = 32768, kSampleBytes = uint64_t(256) << 20;
// Vertices of a part from which its sets' normalization is computed: a share, within bounds; the lower bound
// decreases with many parts.
constexpr uint64_t kNormShare = 64, kLeastForNorm = 512, kMostForNorm = 4096;
constexpr uint64_t kLeastForNorms = 16384, kLeastOfManyForNorm = 64; // of all parts, of each

// Returns the middle of one of `count` stretches into which `all` is divided.
uint64_t middleOf(uint64_t stretch, uint64_t count, uint64_t all) {
    return (2 * stretch + 1) * all / (2 * count);
}

class SampleSink : public BakeSink {
  public:
    explicit SampleSink(const BakePlan& plan) : mPlan(plan) {}

    void take(uint32_t block, BakedBlock baked) override {
        packVisibility(mPlan, block, baked);
        blocks.push_back({block, std::move(baked)});
    }

    std::vector<SampledBlock> blocks;

  private:
    const BakePlan& mPlan;
};

// Adds bounced light to rows of these vertices of a part.
void addBounces(const BakePlan& plan, uint32_t part, std::span<const uint32_t> vertices,
                std::vector<BakedRows>& rows) {
    std::vector<BakedRows> sum;
    for (const BakedRows& set : rows) sum.emplace_back(set.transport.terms);
    for (uint32_t i = 0; i < rows.front().transport.vertices; i++) {
        std::vector<BakedRows> one;
        for (const BakedRows& set : rows) one.push_back(set.vertices(i, i + 1));
        plan.bounced->addTo(one, plan.asset, part, vertices[i]);
        for (size_t set = 0; set < sum.size(); set++) sum[set].append(one[set]);
    }
    rows = std::move(sum);
}

// Returns the normalization of each set, from vertices spread over its part; a few blocks would not do, since
// a ground's shadow is on one in twenty. Kept visibility is not used: it is packed by blocks, and unpacking
// one for a few vertices takes longer than computing theirs.
std::vector<float> unitsOf(const vk::Device& device, BakePlan& plan, const BakeLimits& limits,
                           BakeObserver& observer, BakeTimes& times) {
    std::vector<std::vector<uint32_t>> chosen;
    const uint64_t least =
        std::clamp(kLeastForNorms / plan.asset.parts.size(), kLeastOfManyForNorm, kLeastForNorm);
    for (const AssetPart& part : plan.asset.parts) {
        const uint64_t all = part.mesh.vertexCount();
        const uint64_t count = std::min(all, std::clamp(all / kNormShare, least, kMostForNorm));
        std::vector<uint32_t>& own = chosen.emplace_back();
        for (uint64_t i = 0; i < count; i++) own.push_back(uint32_t(middleOf(i, count, all)));
    }
    const std::vector<float> spectrum = lightSpectrum(plan.asset.faceSize);
    std::vector<float> norms;
    std::vector<NormSum> direct, bounced; // of the sets of one part at a time, so that rows need not be held
    uint32_t summed = 0;                  // that part
    size_t taken = 0;                     // of the vertices of that part
    const auto endPart = [&] {
        for (size_t set = 0; set < direct.size(); set++)
            norms.push_back(plan.bounced ? bounced[set].normBeside(direct[set]) : direct[set].norm());
        direct.clear();
        bounced.clear();
        taken = 0;
    };
    const auto add = [&](std::vector<NormSum>& sums, std::span<const BakedRows> sets) {
        for (size_t set = 0; set < sets.size(); set++) {
            if (sums.size() == set) sums.emplace_back(sets[set].transport.terms, spectrum);
            sums[set].add(sets[set].transport);
        }
    };
    const auto take = [&](uint32_t part, std::span<const BakedRows> sets) {
        if (part != summed) endPart();
        summed = part;
        add(direct, sets);
        if (plan.bounced) {
            std::vector<BakedRows> own(sets.begin(), sets.end());
            addBounces(plan, part, std::span(chosen[part]).subspan(taken), own);
            add(bounced, own);
        }
        taken += sets.front().transport.vertices;
    };
    bakeVertices(device, plan, chosen, limits, take, observer, times);
    endPart();
    return norms;
}

LayoutScale scaleOf(const BakePlan& plan, std::span<const SampledBlock> blocks,
                    const std::vector<float>& norms) {
    std::vector<SetSample> samples; // over all parts
    for (const AssetPart& part : plan.asset.parts)
        for (const MaterialSet& set : part.sets)
            samples.push_back(
                {&set, {}, uint32_t(part.mesh.vertexCount()), norms[samples.size()], plan.asset.bounces > 0});
    for (const SampledBlock& sampled : blocks) {
        const uint32_t firstSet = plan.firstSet[plan.blocks[sampled.block].part];
        for (size_t set = 0; set < sampled.baked.sets.size(); set++)
            samples[firstSet + set].blocks.push_back(&sampled.baked.sets[set].transport);
    }
    return findScale(samples, plan.asset.faceSize, plan.vertices(), plan.options.layout);
}

// Returns the share of these blocks that stays within the limits on vertices and bytes, at most 1.
double shareThatFits(const BakePlan& plan, std::span<const uint32_t> blocks) {
    uint64_t vertices = 0, bytes = 0;
    for (const uint32_t number : blocks) {
        const BakeBlock& block = plan.blocks[number];
        vertices += block.count();
        const AssetPart& part = plan.asset.parts[block.part];
        bytes += block.count() * rowBytes(termCount(part), rowEntries(plan.asset, part));
    }
    return std::min({1.0, double(kMostSampled) / double(std::max<uint64_t>(1, vertices)),
                     double(kSampleBytes) / double(std::max<uint64_t>(1, bytes))});
}

} // namespace

std::vector<uint32_t> sampleBlocks(const BakePlan& plan) {
    const uint64_t all = plan.vertices();
    const uint64_t wanted = std::min(kSampleVertices, all / kSampleShare);
    const uint64_t leastOfPart = std::min(
        kLeastOfPart, std::max<uint64_t>(plan.blockVertices, kSampleVertices / plan.asset.parts.size()));
    std::vector<uint32_t> sample;
    for (uint32_t first = 0, part = 0; part < plan.asset.parts.size(); part++) {
        const uint64_t vertices = plan.asset.parts[part].mesh.vertexCount();
        const uint64_t blocks = (vertices + plan.blockVertices - 1) / plan.blockVertices;
        const uint64_t own = std::max(leastOfPart, wanted * vertices / all);
        const uint64_t count = std::min(blocks, (own + plan.blockVertices - 1) / plan.blockVertices);
        for (uint64_t i = 0; i < count; i++) sample.push_back(first + uint32_t(middleOf(i, count, blocks)));
        first += uint32_t(blocks);
    }
    for (double share = shareThatFits(plan, sample); share < 1 && sample.size() > 1;
         share = shareThatFits(plan, sample)) {
        const uint64_t kept = std::max<uint64_t>(1, uint64_t(share * double(sample.size())));
        std::vector<uint32_t> fewer;
        for (uint64_t i = 0; i < kept; i++) fewer.push_back(sample[middleOf(i, kept, sample.size())]);
        sample = std::move(fewer);
    }
    return sample;
}

std::vector<SampledBlock> bakeSample(const vk::Device& device, BakePlan& plan, const BakeLimits& limits,
                                     BakeObserver& observer, BakeTimes& times, KeptVisibility* kept) {
    const std::vector<uint32_t> blocks = sampleBlocks(plan);
    SampleSink sink(plan);
    StageObserver sampleObserver(observer, BakeStage::Sample);
    bakeBlocks(device, plan, blocks, blocks, limits, sink, sampleObserver, times, kept);
    plan.scale = scaleOf(plan, sink.blocks, unitsOf(device, plan, limits, sampleObserver, times));
    return std::move(sink.blocks);
}

} // namespace relume
